# SPDX-License-Identifier: BSD-3-Clause
"""Tables, and the paper's numbers beside ours."""
from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

import mmbrdf
from study import (
    ALL,
    ISOTROPIC,
    MANUFACTURER,
    PUBLISHED,
    SUBSET_NM,
    WAVELENGTHS_NM,
    Study,
    depolarization_around,
    fourfold_amplitude,
    largest_coefficient_difference,
    pooled,
    reflectance_table,
    rms,
    rms_table,
    subset_numbers,
)

ELEMENTS = [f"{row}{column}" for row in range(1, 5) for column in range(1, 5)]
REFLECTANCES = ["dhr_0", "dhr_8", "dhr_45", "dhr_60", "dhr_75", "bhr", "u_dhr_0"]
STATED_RMS = (
    ("11 / sr⁻¹", 0.004, None),
    ("12, 13, 14", 0.010, "12,21,13,31,14,41"),
    ("22, 23, 24", 0.013, "22,23,32,24,42"),
    ("33", 0.014, "33"),
    ("34", 0.012, "34,43"),
    ("44", 0.011, "44"),
)
STATED_SUBSETS = {"mean_distance": 0.59, "largest_distance": 2.6, "deviation": 0.52}
SUBSET_WORDS = {
    "mean_distance": "mean of \\|mean of three / regular − 1\\|",
    "largest_distance": "largest of them",
    "deviation": "standard deviation of the three, mean",
}


def write(study: Study, folder: Path) -> None:
    """rms.csv, reflectance.csv, subsets.csv, random_directions.csv and report.md."""
    folder.mkdir(parents=True, exist_ok=True)
    rms_rows, reflectance_rows = list(rms_table(study)), list(reflectance_table(study))
    subsets = {
        basis: subset_numbers(study.parts(basis), study.model(basis, SUBSET_NM)) for basis in (PUBLISHED, ISOTROPIC)
    }
    fit_columns = ["basis", "fit", "wavelength_nm"]
    write_csv(folder / "rms.csv", fit_columns + ELEMENTS, [(*row[:3], *row[3].ravel()) for row in rms_rows])
    write_csv(folder / "reflectance.csv", fit_columns + REFLECTANCES, [(*row[:3], *row[3]) for row in reflectance_rows])
    write_csv(
        folder / "subsets.csv",
        ["basis", *(f"{name}_percent" for name in STATED_SUBSETS)],
        [(basis, *numbers.values()) for basis, numbers in subsets.items()],
    )
    write_csv(
        folder / "random_directions.csv",
        ["way", "all_but_11", *ELEMENTS],
        [(way, pooled(values), *values.ravel()) for way, values in study.predictions.items()],
    )
    sections = [
        data_section(study),
        rms_section(rms_rows),
        reflectance_section(reflectance_rows),
        subset_section(subsets),
        fourfold_section(study),
        prediction_section(study),
    ]
    text = "# Germer (2017), beside what this software makes of the same data\n\n"
    (folder / "report.md").write_text(text + "\n".join(sections), encoding="utf-8")


def write_csv(path: Path, columns: list[str], rows) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for row in rows:
            writer.writerow([f"{value:.6g}" if isinstance(value, float) else value for value in row])


def markdown_table(columns: list[str], rows) -> str:
    lines = [columns, ["---"] * len(columns), *rows]
    return "".join("| " + " | ".join(map(str, line)) + " |\n" for line in lines)


def data_section(study: Study) -> str:
    """What was fitted, and how close the coefficients come to those published."""
    counts = [
        np.sum(np.isclose(study.grid.theta_i_deg, theta, atol=0.01)) / len(study.grid.wavelengths_nm)
        for theta in range(0, 90, 15)
    ]
    rows = [
        ("directions for each incident angle", "304", f"{min(counts):g} to {max(counts):g}"),
        ("random pairs of directions", "approximately 1800", len(study.random)),
    ]
    text = "## Data and fits\n\n"
    if study.simulated:
        text += (
            "**The data are simulated**, from the built-in model with speckle: the published ones were not found. "
            "What follows shows how the figures are made; the paper's numbers come out only with the published "
            "data.\n\n"
        )
    text += markdown_table(["", "paper", "here"], rows)
    if study.folder is None:
        return text
    differences = [
        f"{largest_coefficient_difference(study.model(PUBLISHED, which), mmbrdf.load_model(path)):.1e}"
        f" ({path.name})"
        for which, path in published_fits(study.folder)
        if path.exists()
    ]
    if differences:
        text += (
            "\nLargest difference between a coefficient fitted here with the published basis and the published "
            "one: " + ", ".join(differences) + ".\n"
        )
    return text


def published_fits(folder: Path):
    for wavelength in WAVELENGTHS_NM:
        yield wavelength, folder / f"PTFE.{wavelength:g}.coeff.csv"
    yield ALL, folder / "PTFE.coeff.csv"


def rms_section(rms_rows) -> str:
    found = {row[0]: row[3] for row in rms_rows if row[1] == ALL and row[2] == "351-1064"}
    rows = []
    for label, stated, elements in STATED_RMS:
        values = [
            found[basis][0, 0] if elements is None else pooled(found[basis], elements)
            for basis in (PUBLISHED, ISOTROPIC)
        ]
        rows.append((label, f"{stated:.3f}", *(f"{value:.5f}" for value in values)))
    text = "## Residuals of the fits to all wavelengths (rms)\n\n"
    text += markdown_table(["elements, with their transposes", "paper", PUBLISHED, ISOTROPIC], rows)
    text += "\nBy element and wavelength, also of the fits to one wavelength (`rms.csv`):\n\n"
    short = ["11", "12", "13", "14", "22", "23", "24", "33", "34", "44"]
    rows = [(*row[:3], *(f"{pair_rms(row[3], element):.5f}" for element in short)) for row in rms_rows]
    return text + markdown_table(["basis", "fit", "nm"] + short, rows)


def pair_rms(by_element: np.ndarray, element: str) -> float:
    """Of an element and its transpose together."""
    return float(by_element[0, 0]) if element == "11" else pooled(by_element, f"{element},{element[::-1]}")


def reflectance_section(rows) -> str:
    text = (
        "## Directional-hemispherical reflectance\n\nThe paper takes the manufacturer's values at normal "
        "incidence. The fits to one wavelength have them as the data do, those to all wavelengths have them as a "
        "factor. u is the standard uncertainty of the fit alone.\n\n"
    )
    columns = ["basis", "fit", "nm", "paper, 0°", "0°", "u(0°)", "8°", "45°", "60°", "75°", "bihemispherical"]
    lines = [
        (
            *row[:3],
            f"{MANUFACTURER[int(row[2])]:.3f}",
            f"{row[3][0]:.5f}",
            f"{row[3][-1]:.5f}",
            *(f"{value:.5f}" for value in row[3][1:-1]),
        )
        for row in rows
    ]
    return text + markdown_table(columns, lines)


def subset_section(subsets) -> str:
    rows = [
        (SUBSET_WORDS[name], f"{stated:g} %", *(f"{subsets[basis][name]:.4f} %" for basis in (PUBLISHED, ISOTROPIC)))
        for name, stated in STATED_SUBSETS.items()
    ]
    text = (
        f"## Three parts of the random directions ({SUBSET_NM:g} nm, θi = 45°, −60° ≤ θr ≤ 60°)\n\n"
        "The published basis is fitted here at the azimuths as they are. The paper does not say how it treats them "
        "nor how it averages; of the published data this way gives its three numbers, others that were tried do "
        "not.\n\n"
    )
    return text + markdown_table(["", "paper", PUBLISHED, ISOTROPIC], rows)


def fourfold_section(study: Study) -> str:
    rows = []
    for wavelength in WAVELENGTHS_NM:
        models = [study.model(basis, ALL) for basis in (PUBLISHED, ISOTROPIC)]
        around = [depolarization_around(model, wavelength)[1] for model in models]
        rows.append(
            (
                f"{wavelength:g}",
                *(f"{fourfold_amplitude(model, wavelength):.1e}" for model in models),
                *(f"{values.min():.4f} to {values.max():.4f}" for values in around),
            )
        )
    text = (
        '## Four-fold pattern of the depolarization at normal incidence (Fig. 5)\n\nThe paper concedes "a small '
        'four-fold symmetric pattern". At θr = 75°, of the fits to all wavelengths:\n\n'
    )
    columns = ["nm", f"amplitude of cos 4φr, {PUBLISHED}", ISOTROPIC, f"range over φr, {PUBLISHED}", ISOTROPIC]
    return text + markdown_table(columns, rows)


def prediction_section(study: Study) -> str:
    regular = study.grid.at_wavelengths([SUBSET_NM])
    fitted = {
        basis: pooled(rms(mmbrdf.residuals(study.model(basis, SUBSET_NM), regular))) for basis in (PUBLISHED, ISOTROPIC)
    }
    rows = [
        (way, f"{fitted[way.split(',')[0]]:.5f}", f"{pooled(values):.5f}", f"{values[0, 0]:.5f}")
        for way, values in study.predictions.items()
    ]
    text = (
        f"## Prediction of the random directions at {SUBSET_NM:g} nm\n\nFits to the regular directions at that "
        "wavelength; rms of the 15 elements divided by f11, and of f11 in sr⁻¹.\n\n"
    )
    return text + markdown_table(["way", "regular, fitted", "random, predicted", "f11, random"], rows)
