# SPDX-License-Identifier: BSD-3-Clause
"""The paper's seven figures, and what another basis changes."""
from __future__ import annotations

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import mmbrdf.plot
from mmbrdf.plot import colours, curves, disc, maps, panels
from study import ALL, INCIDENT_DEG, ISOTROPIC, PUBLISHED, SUBSET_NM, WAVELENGTHS_NM, Study, depolarization_around

F11_LIMITS, ELEMENT_LIMIT = (0.25, 0.45), 0.1
LINE_STYLES = {351.0: "-", 532.0: "--", 633.0: (0, (5, 1.5, 1, 1.5, 1, 1.5)), 1064.0: "-."}


def matrix_figure(study: Study, basis: str, wavelength_nm: float, samples: int = 101) -> Figure:
    """Figs. 1-4: a column for each incident angle, measured over the fit to all wavelengths."""
    figure = Figure(figsize=(15.4, 5.6))
    # Without a background: what is written on the figure would be below it.
    main, bars = figure.subfigures(1, 2, width_ratios=(14, 1), facecolor="none")
    cells = main.subfigures(3, 7, height_ratios=(0.1, 1, 1), width_ratios=(0.12,) + (1,) * 6, facecolor="none")
    fitted = study.model(basis, ALL)
    for row, (label, source) in enumerate((("measured", study.grid), (f"fit ({basis})", fitted)), start=1):
        label = "simulated" if study.simulated and row == 1 else label
        cells[row, 0].text(0.6, 0.5, label, rotation=90, ha="center", va="center", fontsize=11)
        for column, theta_i_deg in enumerate(INCIDENT_DEG, start=1):
            mmbrdf.plot.hemisphere(
                source,
                wavelength_nm,
                theta_i_deg,
                samples=samples,
                scale="paper",
                f11_limits=F11_LIMITS,
                limit=ELEMENT_LIMIT,
                figure=cells[row, column],
                decorated=False,
            )
    for column, theta_i_deg in enumerate(INCIDENT_DEG, start=1):
        cells[0, column].text(
            0.5, 0.4, rf"$\theta_\mathrm{{i}}$ = {theta_i_deg:g}°", ha="center", va="center", fontsize=11
        )
    bars.text(0.45, 0.99, f"{wavelength_nm:g} nm", ha="center", va="top", fontsize=12)
    scales = (
        ("gray", Normalize(*F11_LIMITS), panels.F11_LABEL, 0.51),
        ("RdBu_r", Normalize(-ELEMENT_LIMIT, ELEMENT_LIMIT), panels.ELEMENT_LABEL, 0.05),
    )
    for cmap, norm, label, bottom in scales:
        bar = bars.colorbar(ScalarMappable(norm, cmap), cax=bars.add_axes((0.08, bottom, 0.2, 0.4)), extend="both")
        bar.set_label(label)
    return figure


def depolarization_figure(study: Study, basis: str, samples: int = 201) -> Figure:
    """Fig. 5: three wavelengths, normal and 60 degrees incidence, one scale for each incidence."""
    figure = Figure(figsize=(9.6, 6.2), layout="constrained")
    axes = figure.subplots(2, 3)
    model = study.model(basis, ALL)
    for row, (theta_i_deg, limits) in enumerate(((0.0, (0.02, 0.05)), (60.0, (0.02, 0.3)))):
        for each, wavelength_nm in zip(axes[row], (351.0, 532.0, 1064.0)):
            mmbrdf.plot.depolarization_map(
                model, wavelength_nm, theta_i_deg, samples=samples, limits=limits, axes=each, colorbar=False
            )
            angle = rf"$\theta_\mathrm{{i}}$ = {theta_i_deg:g}°"
            each.set(xlabel="", ylabel="", title=f"{wavelength_nm:g} nm, {angle}")
        figure.colorbar(
            ScalarMappable(Normalize(*limits), "viridis"), ax=axes[row], extend="both", label="depolarization parameter"
        )
    for each in axes[1]:
        each.set_xlabel(disc.X_LABEL)
    for each in axes[:, 0]:
        each.set_ylabel(disc.Y_LABEL)
    return figure


def curves_figure(study: Study, basis: str) -> Figure:
    """Fig. 6: fits to each wavelength, thin, and to all of them, thick; colours by component, styles by wavelength."""
    axes = _plane_axes()
    for wavelength_nm, style in LINE_STYLES.items():
        for which, width in ((wavelength_nm, 0.7), (ALL, 1.9)):
            mmbrdf.plot.in_plane_curves(
                study.model(basis, which),
                wavelength_nm,
                45.0,
                bands=False,
                axes=axes,
                linestyle=style,
                linewidth=width,
                legend=False,
            )
    styles = [
        Line2D([], [], color="0.35", linestyle=style, label=f"{wavelength_nm:g} nm")
        for wavelength_nm, style in LINE_STYLES.items()
    ]
    widths = [
        Line2D([], [], color="0.35", linewidth=width, label=label)
        for width, label in ((0.7, "one wavelength"), (1.9, ALL))
    ]
    axes.legend(
        handles=curves.component_handles(linestyle="-") + styles + widths, frameon=False, ncol=3, loc="upper left"
    )
    axes.set_title(rf"{basis}, $\theta_\mathrm{{i}}$ = 45°", fontsize=10)
    return axes.figure


def subset_figure(study: Study, basis: str) -> Figure:
    """Fig. 7: fits to three parts of the random directions, thin, and to the regular ones, thick."""
    axes = _plane_axes()
    mmbrdf.plot.subset_study(
        study.parts(basis), study.model(basis, SUBSET_NM), SUBSET_NM, 45.0, axes=axes, legend=False
    )
    widths = [
        Line2D([], [], color="0.35", linewidth=0.9, label="a third of the random directions"),
        Line2D([], [], color="0.35", linewidth=2.4, label="regular directions"),
    ]
    axes.legend(handles=curves.component_handles() + widths, frameon=False, ncol=2, loc="upper left")
    axes.set_title(rf"{basis}, {SUBSET_NM:g} nm, $\theta_\mathrm{{i}}$ = 45°", fontsize=10)
    return axes.figure


def _plane_axes():
    axes = Figure(figsize=(7.2, 5.2), layout="constrained").add_subplot()
    axes.set(
        xlim=(-90, 90),
        xticks=range(-90, 91, 15),
        ylim=(0.1, 0.25),
        ylabel=r"$f_\mathrm{r}$ / sr$^{-1}$",
        xlabel=r"scattering polar angle $\theta_\mathrm{r}$ / °",
    )
    axes.tick_params(direction="in", top=True, right=True)
    return axes


def fourfold_figure(study: Study) -> Figure:
    """The depolarization parameter around the normal: for an isotropic sample it must be constant."""
    axes = Figure(figsize=(6.8, 4.2), layout="constrained").add_subplot()
    for wavelength_nm, stroke in zip((351.0, 532.0, 1064.0), colours.series(3)):
        for basis, style in ((PUBLISHED, "-"), (ISOTROPIC, "--")):
            phi_r_deg, values = depolarization_around(study.model(basis, ALL), wavelength_nm, steps=360)
            axes.plot(phi_r_deg, values, style, color=stroke.color, label=f"{basis}, {wavelength_nm:g} nm")
    axes.set(
        xlim=(0, 359),
        xticks=range(0, 360, 45),
        xlabel=r"scattering azimuth $\phi_\mathrm{r}$ / °",
        ylabel=maps.DEPOLARIZATION_LABEL,
        title=r"normal incidence, $\theta_\mathrm{r}$ = 75°, fits to all wavelengths",
    )
    axes.legend(frameon=False, ncol=3, fontsize=8, loc="lower center", bbox_to_anchor=(0.5, 1.08))
    return axes.figure


def prediction_figure(study: Study) -> Figure:
    """What the fit to the regular directions leaves of the random ones, element by element."""
    axes = Figure(figsize=(7.2, 4.2), layout="constrained").add_subplot()
    elements = [f"{row}{column}" for row in range(1, 5) for column in range(1, 5)][1:]
    markers = ("s", "#c14a09"), ("o", "#7f7f7f"), ("D", "#12408c")
    for (name, values), (marker, color) in zip(study.predictions.items(), markers):
        axes.plot(
            np.arange(15),
            values.ravel()[1:],
            marker,
            color=color,
            label=name,
            **dict(markersize=9, fillstyle="none") if marker == "o" else dict(markersize=5),
        )
    axes.set(
        xticks=np.arange(15),
        ylim=(0, None),
        xlabel="element",
        ylabel="rms of measured $-$ predicted $m_{ij}$",
        title=f"random directions at {SUBSET_NM:g} nm, predicted from the regular ones",
    )
    axes.set_xticklabels(elements)
    axes.grid(axis="y", color="0.9")
    axes.set_axisbelow(True)
    axes.legend(frameon=False)
    return axes.figure


def figures(basis: str):
    """Names of the paper's figures and what draws them from a study."""
    for number, wavelength_nm in enumerate(WAVELENGTHS_NM, start=1):
        yield f"fig{number}", lambda study, nm=wavelength_nm: matrix_figure(study, basis, nm)
    yield "fig5", lambda study: depolarization_figure(study, basis)
    yield "fig6", lambda study: curves_figure(study, basis)
    yield "fig7", lambda study: subset_figure(study, basis)
    if basis == ISOTROPIC:
        yield "fourfold", fourfold_figure
        yield "random_directions", prediction_figure
