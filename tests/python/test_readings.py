# SPDX-License-Identifier: BSD-3-Clause
"""Readings of a polarimeter as tables, beside files: the same instrument, the same samples."""

import csv
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import mmbrdf


@pytest.fixture(scope="module")
def goniometer():
    return mmbrdf.Goniometer(1)


@pytest.fixture(scope="module")
def files(goniometer, ptfe, tmp_path_factory):
    folder = tmp_path_factory.mktemp("readings")
    goniometer.write_references(folder / "references.csv", 532)
    goniometer.write_raw(folder / "raw.csv", ptfe, 532, mmbrdf.in_plane(45, [0, 30, 60]))
    return folder


def table(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    text = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    return {name: values if name == "reference" else values.astype(float) for name, values in text.items()}


def same_instrument(one, other):
    np.testing.assert_array_equal(one.polarimeter.generator, other.polarimeter.generator)
    np.testing.assert_array_equal(one.polarimeter.analyzer, other.polarimeter.analyzer)
    np.testing.assert_array_equal(one.covariance, other.covariance)


def tables(given):
    yield "dict", given
    yield "lists", {name: list(values) for name, values in given.items()}
    yield "one wavelength", {**given, "wavelength_nm": 532}
    from_0 = {name: values - 1 if name.endswith("_state") else values for name, values in given.items()}
    yield "states from 0", from_0
    kinds = [(name, values.dtype) for name, values in given.items()]
    structured = np.zeros(len(given["number"]), kinds)
    for name, values in given.items():
        structured[name] = values
    yield "structured", structured
    yield "more columns", {**given, "operator": np.full(len(given["number"]), "me, myself")}


def test_tables_are_what_files_are(files, goniometer):
    expected = mmbrdf.calibrate(files / "references.csv", film=goniometer.film)
    for _, given in tables(table(files / "references.csv")):
        same_instrument(mmbrdf.calibrate(given, film=goniometer.film), expected)
    samples = mmbrdf.reduce(files / "raw.csv", expected, solid_angle=1e-4)
    for _, given in tables(table(files / "raw.csv")):
        found = mmbrdf.reduce(given, expected, solid_angle=1e-4)
        np.testing.assert_array_equal(found.mueller, samples.mueller)
        np.testing.assert_array_equal(found.uncertainty, samples.uncertainty)
        assert found.reduction.startswith("raw by ")


def test_states_from_0_are_so_in_both_columns_though_one_is_never_0(files, goniometer):
    given, whole = table(files / "raw.csv"), goniometer.polarimeter
    expected = mmbrdf.reduce(given, whole, solid_angle=1e-4)
    more = np.vstack([whole.analyzer[:1], whole.analyzer])  # the first is never used
    pairs = [(p, q) for q in range(1, len(more)) for p in range(len(whole.generator))]
    instrument = mmbrdf.Polarimeter(whole.generator, more, pairs)
    found = mmbrdf.reduce({**given, "generator_state": given["generator_state"] - 1}, instrument, solid_angle=1e-4)
    np.testing.assert_allclose(found.mueller, expected.mueller, rtol=0, atol=1e-12)


def test_frames_of_data_and_datasets_are_tables(files, goniometer):
    pandas = pytest.importorskip("pandas")
    expected = mmbrdf.calibrate(files / "references.csv", film=goniometer.film)
    frame = pandas.read_csv(files / "references.csv", float_precision="round_trip")
    same_instrument(mmbrdf.calibrate(frame, film=goniometer.film), expected)


def test_a_dataset_of_xarray_is_a_table(files, goniometer):
    xarray = pytest.importorskip("xarray")
    expected = mmbrdf.calibrate(files / "references.csv", film=goniometer.film)
    given = table(files / "references.csv")
    wavelength = given.pop("wavelength_nm")[0]
    dataset = xarray.Dataset({name: ("row", values) for name, values in given.items()}, {"wavelength_nm": wavelength})
    same_instrument(mmbrdf.calibrate(dataset, film=goniometer.film), expected)


def test_columns_have_other_names_in_tables_and_files(files, goniometer, tmp_path):
    expected = mmbrdf.calibrate(files / "references.csv", film=goniometer.film)
    given = table(files / "references.csv")
    names = {"intensity": "V", "angle_deg": "dial"}
    other = {{v: k for k, v in {"V": "intensity", "dial": "angle_deg"}.items()}.get(n, n): v for n, v in given.items()}
    same_instrument(mmbrdf.calibrate(other, columns=names, film=goniometer.film), expected)
    text = (files / "references.csv").read_text().replace("intensity", "V", 1).replace("angle_deg", "dial", 1)
    (tmp_path / "named.csv").write_text("# of today\n" + text)
    same_instrument(mmbrdf.calibrate(tmp_path / "named.csv", columns=names, film=goniometer.film), expected)


def test_all_that_is_missing_is_said_at_once(files, goniometer, tmp_path):
    given = table(files / "references.csv")
    for name in ("number", "generator_state", "intensity"):
        del given[name]
    message = (
        r"^references: no column number, generator_state, intensity; there are wavelength_nm, reference, .*'number'"
    )
    with pytest.raises(ValueError, match=message):
        mmbrdf.calibrate(given)
    (tmp_path / "bad.csv").write_text("wavelength_nm,reference,angle_deg,analyzer_state\n")
    with pytest.raises(OSError, match="bad.csv:1: no column number, generator_state, intensity$"):
        mmbrdf.calibrate(tmp_path / "bad.csv")
    with pytest.raises(ValueError, match="no column V, as columns has it; there are wavelength_nm, "):
        mmbrdf.calibrate(given, columns={"intensity": "V"})
    with pytest.raises(ValueError, match="columns: nothing is called volts here; there are "):
        mmbrdf.calibrate(given, columns={"volts": "V"})
    with pytest.raises(ValueError, match="raw: no column theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg; there are "):
        mmbrdf.reduce(table(files / "references.csv"), goniometer.polarimeter, solid_angle=1e-4)


def test_what_is_wrong_in_a_table_is_said_with_its_row(files, goniometer):
    given = table(files / "references.csv")
    with pytest.raises(ValueError, match=r"^references, row 17: intensity: -1"):
        mmbrdf.calibrate(
            {**given, "intensity": np.where(np.arange(len(given["number"])) == 17, -1, given["intensity"])}
        )
    with pytest.raises(ValueError, match="columns of different lengths: .*intensity 3"):
        mmbrdf.calibrate({**given, "intensity": [1, 2, 3]})
    with pytest.raises(TypeError, match="references: expected a path, or a table with keys and arrays .* not int"):
        mmbrdf.calibrate(5)
    with pytest.raises(FileNotFoundError):
        mmbrdf.calibrate("nowhere.csv", columns={"intensity": "V"})


def test_the_misfit_of_each_reference_and_element_can_be_had(files, goniometer):
    found = mmbrdf.calibrate(files / "references.csv", film=goniometer.film)
    each = np.array([one.figure_of_merit for one in found.references])
    assert len(each) == 54 and {one.kind for one in found.references} == set(found.figure_of_merit_by_kind)
    # Root mean squares of the same differences: over references, over elements, and of all.
    np.testing.assert_allclose(np.sqrt(np.mean(each**2)), found.figure_of_merit, rtol=1e-9)
    elements = found.figure_of_merit_by_element.ravel()[1:]
    np.testing.assert_allclose(np.sqrt(np.mean(elements**2)), found.figure_of_merit, rtol=1e-9)
    for kind, value in found.figure_of_merit_by_kind.items():
        own = [one.figure_of_merit for one in found.references if one.kind == kind]
        np.testing.assert_allclose(np.sqrt(np.mean(np.square(own))), value, rtol=1e-9)
    n = 4 * len(found.polarimeter.generator)
    u = np.sqrt(np.diag(found.covariance))
    np.testing.assert_array_equal(found.generator_uncertainty.ravel(), u[:n])
    np.testing.assert_array_equal(found.analyzer_uncertainty.ravel(), u[n:])
    # 54 references with 16 readings; noise of 0.1 % as it was declared, of some 750 degrees of freedom: within 5 s.
    assert abs(found.chi_squared / found.degrees_of_freedom - 1) < 5 * np.sqrt(2 / found.degrees_of_freedom)


def test_matplotlib_comes_when_it_is_asked_for():
    program = (
        "import sys, mmbrdf\n"
        "assert 'matplotlib' not in sys.modules and 'plot' in dir(mmbrdf)\n"
        "help(mmbrdf.plot)\n"
        "assert callable(mmbrdf.plot.map) and 'matplotlib' in sys.modules\n"
        "try: mmbrdf.nothing\n"
        "except AttributeError as error: print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "Help on package mmbrdf.plot" in done.stdout and "has no attribute 'nothing'" in done.stdout


def test_the_calls_of_the_documentation_run_as_they_stand(files):
    page = (Path(__file__).parents[2] / "docs/python.md").read_text(encoding="utf-8")
    block = page[page.index("**Readings of a polarimeter**") :].split("```")[1].removeprefix("python\n")
    given = table(files / "references.csv")
    short = {
        "kind": "reference",
        "angle": "angle_deg",
        "p": "generator_state",
        "q": "analyzer_state",
        "volts": "intensity",
    }
    names = {"mmbrdf": mmbrdf, "number": given["number"], **{name: given[column] for name, column in short.items()}}
    exec(block, names)
    assert names["instrument"].figure_of_merit < 0.001
