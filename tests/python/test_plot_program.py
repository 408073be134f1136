# SPDX-License-Identifier: BSD-3-Clause
"""python3 -m mmbrdf.plot, and mmbrdf plot: pictures from a shell."""

import os
import subprocess
import sys
import xml.etree.ElementTree as xml

import numpy as np
import pytest
from matplotlib.image import imread

import mmbrdf
import mmbrdf.plot
from mmbrdf.plot import __main__ as command


@pytest.fixture
def files(tmp_path, monkeypatch, samples):
    """A folder with a model, samples, an instrument and its references."""
    monkeypatch.chdir(tmp_path)
    samples.save("data.csv")
    mmbrdf.material("ptfe-532").save("model.json")
    goniometer = mmbrdf.Goniometer(seed=1)
    goniometer.write_references("references.csv", 532)
    mmbrdf.calibrate("references.csv", film=goniometer.film).save("instrument.json")
    return tmp_path


def called(text):
    return command.main(text.split())


KINDS = {
    "anisotropy": "ptfe",
    "by-wavelength": "ptfe -w 351 532 -i 30",
    "calibration": "instrument.json references.csv --film 1.4607,1.0,4.15,0.044",
    "coefficient-spectrum": "ptfe --power 1",
    "depolarization-map": "ptfe -w 532 -i 60",
    "directions": "data.csv",
    "hemisphere": "data.csv -i 60 --scale paper",
    "in-plane-curves": "model.json data.csv -i 60",
    "low-order-residuals": "data.csv",
    "map": "data.csv model.json -i 60 --quantity 22 --shown-frame sp",
    "polar-in-plane": "ptfe -w 351,532 -i 30",
    "realizability-map": "ptfe -w 532",
    "reflectance-against-angle": "model.json",
    "reflectance-against-wavelength": "ptfe -w 400 500 -i 8,45",
    "reflectance-factor": "ptfe -w 351 532 --view 0,0 --view 30,180 --term scale=0.3% --coverage 1",
    "residual-map": "model.json data.csv -i 60",
    "residuals": "model.json data.csv",
    "suspicious": "data.csv",
    "uncertainty-parts": "ptfe -w 532 --quantity f_ss --term calibration=0.001",
}


def test_every_kind_is_drawn_at_the_width_that_is_asked_for(files, capsys):
    assert KINDS.keys() == command._SOURCES.keys()
    for kind, rest in KINDS.items():
        assert called(f"{kind} {rest} -o {kind}.png --width 8 --dpi 100") == 0, capsys.readouterr().err
        assert imread(f"{kind}.png").shape[1] == pytest.approx(8 / 2.54 * 100, abs=1)


def test_every_picture_is_a_kind_but_those_of_several_fits_and_designs():
    functions = {name.replace("_", "-") for name in mmbrdf.plot.__all__}
    assert functions - command._SOURCES.keys() == {"plan", "subset-study"}


def test_a_file_has_the_format_of_its_ending_and_is_the_same_each_time(files):
    for ending, begins in (("pdf", b"%PDF"), ("png", b"\x89PNG")):
        for name in ("a", "b"):
            assert called(f"in-plane-curves ptfe -w 532 -o {name}.{ending}") == 0
        assert (files / f"a.{ending}").read_bytes().startswith(begins)
    assert (files / "a.pdf").read_bytes() == (files / "b.pdf").read_bytes()
    assert called("in-plane-curves ptfe -w 532 -o a.SVG") == 0
    assert xml.parse(files / "a.SVG").getroot().tag.endswith("svg")


@pytest.mark.parametrize(
    "words, asked",
    [
        ("--quantity purity", {"quantity": "purity"}),
        ("--quantity f11", {"quantity": "11"}),
        ("--quantity scattered_S2 --stokes 1,0.5,0,-0.1", {"quantity": "scattered_S2", "stokes": [1, 0.5, 0, -0.1]}),
    ],
)
def test_the_same_picture_as_in_python(files, words, asked):
    assert called(f"map ptfe -w 532 -i 60 {words} --width 8 --dpi 100 -o shell.png") == 0
    figure, _ = mmbrdf.plot.map(mmbrdf.material("ptfe"), wavelength_nm=532, theta_i_deg=60, width_cm=8, **asked)
    figure.savefig("python.png", dpi=100)
    np.testing.assert_array_equal(imread("shell.png"), imread("python.png"))


@pytest.mark.parametrize(
    "words, message",
    [
        ("hemisphere ptfe -w 532 -o a.jpg", "-o a.jpg: expected a file that ends with .pdf, .png, .svg"),
        ("hemisphere ptfe -w 532 --term a=1 -o a.png", "hemisphere takes no --term"),
        ("residual-map model.json -o a.png", "residual-map takes model and data"),
        ("hemisphere ptfe -w 532nm -o a.png", "'532nm': expected numbers, as in 443,555"),
        ("hemispheres ptfe -o a.png", "invalid choice: 'hemispheres'"),
    ],
)
def test_wrong_usage_is_said_with_status_2(files, capsys, words, message):
    with pytest.raises(SystemExit) as stopped:
        called(words)
    assert stopped.value.code == 2 and message in capsys.readouterr().err
    assert not list(files.glob("a.*"))


@pytest.mark.parametrize(
    "words, message",
    [
        ("hemisphere nowhere.json -o a.png", ": nowhere.json: no such file, and not a built-in model (ptfe, "),
        ("residual-map model.json nowhere.csv -o a.png", ": nowhere.csv: no such file"),
        ("calibration nowhere.json references.csv -o a.png", ": nowhere.json: "),
        ("hemisphere ptfe -w 532 633 -o a.png", "hemisphere takes one wavelength"),
        ("hemisphere ptfe -o a.png", "the model depends on the wavelength"),
        ("directions ptfe -o a.png", "ptfe: expected samples"),
        ("in-plane-curves data.csv -o a.png", "data.csv: expected a model"),
        ("reflectance-factor ptfe -w 532 --view 30 -o a.png", "--view 30: expected 2 numbers"),
        ("reflectance-factor ptfe -w 532 --term scale -o a.png", "--term scale: expected NAME=VALUE"),
        (
            "reflectance-factor ptfe -w 532 --term scale=0.3% --term scale=0.4% -o a.png",
            "--term scale=0.4%: scale is given twice",
        ),
        ("map ptfe -w 532 --quantity scattered_S1 -o a.png", "needs stokes"),
        ("map ptfe -w 532 --quantity scattered_S1 --stokes 1,0 -o a.png", "--stokes 1,0: expected 4 numbers"),
        ("map ptfe -w 532 --quantity f12 -o a.png", "quantity = 'f12': expected one of 11, 12"),
        (
            "hemisphere ptfe -w 532 --frame sp -o a.png",
            "--frame: of a table of samples, --shown-frame that of the picture, and ptfe is none",
        ),
        ("hemisphere ptfe -w 532 --columns f11=BRDF -o a.png", "--columns: of a table of samples, and ptfe is none"),
        ("directions data.csv --columns f11=BRDF -o a.png", "data.csv:1: no column BRDF"),
        ("hemisphere model.json -o nowhere/a.png", ": nowhere/a.png: No such file or directory\n"),
    ],
)
def test_bad_input_is_said_in_a_line_with_status_1_and_nothing_is_written(files, capsys, words, message):
    assert called(words) == 1
    printed = capsys.readouterr().err
    assert message in printed and printed.count("\n") == 1 and printed.startswith("python3 -m mmbrdf.plot: ")
    assert not list(files.glob("a.*"))


OF_OTHERS = {"theta_i_deg": "AOI", "phi_i_deg": "AZI", "theta_r_deg": "AOR", "phi_r_deg": "AZR"}
COLUMNS = "--columns " + ",".join(f"{own}={theirs}" for own, theirs in OF_OTHERS.items())


def write_table(path, data, elements):
    """With names of its own; ``elements`` are columns of one number for each sample."""
    angles = {theirs: getattr(data, own) for own, theirs in OF_OTHERS.items()}
    columns = {"wavelength_nm": data.wavelength_nm, **angles, **elements}
    rows = zip(*(np.asarray(values).tolist() for values in columns.values()))
    path.write_text("\n".join(",".join(map(str, row)) for row in [columns, *rows]) + "\n")


@pytest.fixture
def twins(files, samples):
    """data.csv in the frame sp, whole and as intensities of s and p, under names of others."""
    sp = mmbrdf.change_frame(samples.mueller, *samples.geometry, "xy", "sp")
    names = {f"m{row + 1}{column + 1}": (row, column) for row, column in np.ndindex(4, 4) if (row, column) != (0, 0)}
    normalized = {name: sp[:, row, column] / sp[:, 0, 0] for name, (row, column) in names.items()}
    write_table(files / "whole.csv", samples, {"f11": samples.f11, **normalized})
    write_table(
        files / "s_and_p.csv",
        samples,
        {f"f_{name}": getattr(mmbrdf.co_and_cross_polarized(sp), name) for name in ("ss", "sp", "ps", "pp")},
    )
    return files


@pytest.mark.parametrize(
    "kind, more",
    [("hemisphere", ""), ("residual-map model.json", ""), ("in-plane-curves model.json", ""), ("map", "--quantity 12")],
)
def test_a_table_in_sp_with_names_of_its_own_gives_the_picture_of_its_twin_in_xy(twins, capsys, kind, more):
    words = f"{more} -i 60 --width 8 --dpi 100"
    assert called(f"{kind} data.csv {words} -o twin.png") == 0 and capsys.readouterr().err == ""
    assert called(f"{kind} whole.csv {COLUMNS} --frame sp {words} -o whole.png") == 0
    assert "note: whole.csv: AOI is theta_i_deg" in capsys.readouterr().err
    np.testing.assert_allclose(imread("whole.png"), imread("twin.png"), atol=2 / 255)  # rounding of a colour


def test_a_table_is_read_as_read_samples_and_all_commands_read_it(twins):
    assert called(f"hemisphere whole.csv {COLUMNS} -i 60 --width 8 --dpi 100 -o shell.png") == 0
    data = mmbrdf.read_samples("whole.csv", columns=OF_OTHERS)  # no frame: xy
    figure, _ = mmbrdf.plot.hemisphere(data, None, 60, width_cm=8)
    figure.savefig("python.png", dpi=100)
    np.testing.assert_array_equal(imread("shell.png"), imread("python.png"))
    assert called("hemisphere data.csv -i 60 --width 8 --dpi 100 -o xy.png") == 0
    assert np.abs(imread("shell.png") - imread("xy.png")).max() > 0.5


def test_intensities_of_s_and_p_are_shown_as_they_were_measured_out_of_plane_too(twins, samples):
    read = mmbrdf.read_samples("s_and_p.csv", columns=OF_OTHERS)
    assert np.isnan(read.normalized).any()  # of what xy would mix with the unmeasured
    whole = mmbrdf.read_samples("whole.csv", columns=OF_OTHERS, frame="sp")
    for quantity in ("f_sp", "12"):
        shown = [
            mmbrdf.plot.map(data, quantity, None, 60, frame="sp")[1].images[0].get_array() for data in (read, whole)
        ]
        assert np.isfinite(np.ma.filled(shown[1], np.nan)).sum() > 100
        np.testing.assert_allclose(np.ma.filled(shown[0], np.nan), np.ma.filled(shown[1], np.nan), atol=1e-12)


def test_terms_are_written_as_those_of_the_program():
    terms = [command._term(text) for text in ("scale=0.3%", "theta_r=0.02deg", "theta_i_deg=0.1", "calibration=0.001")]
    assert dict(terms) == {"scale": 0.003, "theta_r_deg": 0.02, "theta_i_deg": 0.1, "calibration": 0.001}


def test_a_picture_names_the_model_and_its_file_where_that_is_called_otherwise(files):
    options = command._parser("plot").parse_args("hemisphere model.json -o a.png".split())
    named = lambda file: command._opened(file, "model", options).name  # noqa: E731
    assert named("model.json") == "model.json (ptfe-532)" and named("ptfe") == "ptfe"
    mmbrdf.material("ptfe-532").renamed("mine").save("mine.json")
    assert named("mine.json") == "mine"
    mmbrdf.in_published_form(mmbrdf.material("ptfe-532")).save("published.csv")
    assert named("published.csv") == "published"  # which has no place for a name


def test_what_a_picture_is_of_is_not_overwritten(files, capsys):
    (files / "data.png").symlink_to("data.csv")
    before = (files / "data.csv").read_bytes()
    assert called("directions data.csv -o data.png") == 1
    assert "would overwrite data.csv" in capsys.readouterr().err and (files / "data.csv").read_bytes() == before


def run(environment, *words):
    program = os.environ["MMBRDF_PROGRAM"]
    return subprocess.run([program, "plot", *words], env=os.environ | environment, capture_output=True, text=True)


def test_the_program_draws_through_python(files):
    done = run({"MMBRDF_PYTHON": sys.executable}, *"in-plane-curves ptfe -w 532 -o a.svg".split())
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "") and (files / "a.svg").stat().st_size > 10_000
    done = run({"MMBRDF_PYTHON": sys.executable}, *"directions ptfe -o b.png".split())
    assert (done.returncode, done.stderr) == (1, "mmbrdf plot: ptfe: expected samples\n")


def test_the_program_says_in_a_line_that_it_has_no_python(files):
    done = run({"MMBRDF_PYTHON": "/nowhere/python3"}, *"directions data.csv -o a.png".split())
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    assert "plot is drawn by Python: /nowhere/python3: No such file or directory; MMBRDF_PYTHON names" in done.stderr
    done = run({"MMBRDF_PYTHON": sys.executable, "PYTHONPATH": ""}, *"directions data.csv -o a.png".split())
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    assert "mmbrdf: plot needs the Python package mmbrdf and matplotlib: No module named 'mmbrdf'" in done.stderr
