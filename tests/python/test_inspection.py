# SPDX-License-Identifier: BSD-3-Clause
"""Samples before they are fitted: the pictures of where they are and which stand out, and the page with both."""
import html
import json
import pickle
import re
import subprocess
import sys

import numpy as np
import pytest

import mmbrdf

pytest.importorskip("matplotlib")

from matplotlib.collections import PathCollection  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402

import mmbrdf.plot  # noqa: E402
from mmbrdf import _report  # noqa: E402
from pictures import rendered, written  # noqa: E402


def relative_deg(data):
    """Azimuth of the detector from the source, -180 to 180."""
    return (data.phi_r_deg - data.phi_i_deg + 180) % 360 - 180


def with_values(data, mueller):
    return mmbrdf.Dataset(data.wavelength_nm, *data.geometry, mueller)


@pytest.fixture(scope="module")
def half(samples):
    """Of detectors on the forward side only."""
    return samples[np.abs(relative_deg(samples)) > 90]


@pytest.fixture(scope="module")
def faulty(samples):
    """Multiplied by pi, and two fill values."""
    mueller = samples.mueller * np.pi
    mueller[[100, 400]] = -999
    return with_values(samples, mueller)


def points(axes):
    """Places of the samples."""
    return np.asarray(next(each for each in axes.collections if isinstance(each, PathCollection)).get_offsets())


# What cannot be told


def test_three_samples_say_what_cannot_be_told(samples):
    seen = mmbrdf.inspect(samples[[10, 500, 900]])
    assert seen.findings == ()
    assert {one.fault for one in seen.untested} >= {"scale of f11", "cosine", "frame or signs"}
    assert seen.untested[0].reason.startswith("3 samples")
    assert seen.verdict == "nothing seems to be wrong, as far as can be told"
    assert repr(seen).startswith(
        "<mmbrdf.Inspection: nothing seems to be wrong, as far as can be told; cannot be told: "
    )


def test_radians_that_are_called_degrees_are_found_and_nothing_else(samples):
    signed = [samples.theta_i_deg, (samples.phi_i_deg + 180) % 360 - 180, samples.theta_r_deg, samples.phi_r_deg]
    seen = mmbrdf.inspect(mmbrdf.Dataset(532, *np.radians(signed), samples.mueller))
    assert [one.fault for one in seen.findings] == ["angles in radians"]
    assert "theta_i_rad" in seen.findings[0].remedy
    assert {one.reason for one in seen.untested} == {"the angles are to be right first"}


def test_findings_have_their_samples_and_the_others_a_residual(faulty):
    seen = mmbrdf.inspect(faulty)
    assert [one.fault for one in seen.findings] == ["fill values", "scale of f11"]
    assert seen.findings[0].samples == (100, 400) and "101, 401" in seen.findings[0].evidence
    assert seen.findings[1].samples == ()
    assert np.flatnonzero(np.isnan(seen.residuals)).tolist() == [100, 400]
    rest = ~np.isnan(seen.residuals)
    left = np.sqrt(np.mean(seen.residuals[rest] ** 2) / np.mean(faulty.f11[rest] ** 2))
    # The fit is to 1500 of the 1824 samples.
    assert left == pytest.approx(seen.f11_residual, rel=0.1)


def test_the_hole_is_the_same_in_words_in_numbers_and_in_shares(half):
    seen = mmbrdf.inspect(half)
    low, high = seen.hole_deg["phi_r_phi_i"]
    assert f"phi_r - phi_i {low:g} to {high:g}" in seen.hole
    missing = seen.missing
    assert missing.detector.shape == (len(missing.theta_deg), len(missing.phi_deg))
    at = {phi: missing.detector[5, k] for k, phi in enumerate(missing.phi_deg)}  # at theta_r = 25 degrees
    assert missing.theta_deg[5] == 25 and at[0] > 0.9 and at[180] < 0.1  # the normal counts for all azimuths
    assert np.isnan(missing.theta_i[-1]), "no source at 90 degrees"


# Where was measured


def test_the_discs_show_the_directions_and_how_many_samples_have_each(samples):
    figure, (source, detector) = mmbrdf.plot.directions(samples)
    distinct = np.unique(np.round(samples.theta_i_deg, 1))
    at = points(source)
    # The source is at azimuth 180 in these data. The grid writes 0.001 degrees for the normal.
    np.testing.assert_allclose(np.sort(np.hypot(*at.T)), np.sin(np.radians(distinct)), atol=1e-4)
    assert at[:, 0].min() < -0.9 and abs(at[:, 1]).max() < 1e-4
    counts = source.collections[0].get_array()
    assert counts.sum() == len(samples) and sorted(counts) == sorted(
        np.unique(np.round(samples.theta_i_deg, 1), return_counts=True)[1]
    )
    sizes = source.collections[0].get_sizes()
    assert sizes[counts.argmax()] == sizes.max()
    assert detector.collections[0].get_array().sum() == len(samples)
    text = written(figure)
    assert all(name in text for name in ("source: 6 directions", "30°", "60°", "90°", "forward", "towards the source"))
    assert "covered: 100 % of the pairs" in text


def test_the_detector_is_seen_from_the_source_whose_azimuth_is_kept(samples):
    turn = 70.0
    geometry = samples.geometry
    turned = mmbrdf.Dataset(
        532,
        geometry.theta_i_deg,
        geometry.phi_i_deg + turn,
        geometry.theta_r_deg,
        geometry.phi_r_deg + turn,
        samples.mueller,
    )
    seen = mmbrdf.inspect(samples)
    _, before = mmbrdf.plot.directions(samples, inspection=seen)
    _, after = mmbrdf.plot.directions(turned, inspection=seen)
    key = lambda at: at[np.lexsort(np.round(at, 3).T)]  # noqa: E731
    np.testing.assert_allclose(key(points(before[1])), key(points(after[1])), atol=1e-5)
    far = lambda at: at[np.hypot(*at.T).argmax()]  # noqa: E731
    x, y = far(points(after[0]))
    assert np.degrees(np.arctan2(y, x)) % 360 == pytest.approx((180 + turn) % 360, abs=0.1)


def hatched(axes):
    """Whether there is a hatch, and where it reaches in x."""
    paths = [
        path.vertices
        for each in axes.collections
        if getattr(each, "get_hatch", lambda: None)() or getattr(each, "hatches", None)
        for path in each.get_paths()
        if len(path.vertices)
    ]
    return np.concatenate(paths)[:, 0] if paths else np.array([])


def test_the_hole_is_hatched_and_said(half, samples):
    figure, (source, detector) = mmbrdf.plot.directions(half)
    reach = hatched(detector)
    # Samples begin at x = 0.1, and count as far as the next node.
    assert reach.min() < -0.9 and reach.max() < 0.1
    assert source.patches and not any(patch.get_hatch() for patch in source.patches)
    words = written(figure).replace("\n", " ").replace("\u00a0", " ")
    assert mmbrdf.inspect(half).hole in words
    assert len(hatched(mmbrdf.plot.directions(samples)[1][1])) == 0


def test_polar_angles_without_a_source_are_hatched(ptfe):
    data = mmbrdf.simulate(ptfe, 532, mmbrdf.random_geometries(20, seed=3))
    seen = mmbrdf.inspect(data)
    _, (source, _) = mmbrdf.plot.directions(data, inspection=seen)
    radii = sorted(patch.r for patch in source.patches if patch.get_hatch())
    missing = seen.missing.theta_deg[seen.missing.theta_i > 0.95]
    assert len(missing) > 0
    np.testing.assert_allclose(radii, np.sin(np.radians(missing + 2.5)))  # half way between nodes


def test_the_discs_are_drawn_for_one_sample_and_in_a_subfigure(samples):
    figure, _ = mmbrdf.plot.directions(samples[:1])
    rendered(figure)
    left, _ = Figure().subfigures(1, 2)
    assert mmbrdf.plot.directions(samples[:9], figure=left)[0] is left


def test_grey_prints_tell_counts_too():
    from matplotlib import colormaps

    red, green, blue = colormaps[mmbrdf.plot.samples.COUNTS](np.linspace(0, 1, 9))[:, :3].T
    lightness = 0.2126 * red**2.2 + 0.7152 * green**2.2 + 0.0722 * blue**2.2
    assert (np.diff(lightness) < 0).all() and lightness[0] > 5 * lightness[-1]


# Which stand out


def test_suspicious_samples_are_marked_and_do_not_set_the_scale(faulty):
    figure, axes = mmbrdf.plot.suspicious(faulty)
    shown = points(axes)
    assert len(shown) == len(faulty) - 2
    forward = np.abs(relative_deg(faulty)) > 90 - 1e-4
    kept = np.setdiff1d(np.arange(len(faulty)), [100, 400])
    np.testing.assert_allclose(shown[:, 1], faulty.f11[kept])
    np.testing.assert_allclose(np.abs(shown[:, 0]), faulty.theta_r_deg[kept])
    assert (shown[faulty.theta_r_deg[kept] > 1][:, 0] > 0).sum() == (forward & (faulty.theta_r_deg > 1))[kept].sum()
    low, high = axes.get_ylim()
    assert 0 < low < high < 5
    assert "fill values: 2" in written(figure)
    assert np.allclose(points_of_marks(axes)[:, 1], low)


def points_of_marks(axes):
    offsets = [np.asarray(each.get_offsets()) for each in axes.collections[1:]]
    return np.concatenate([some for some in offsets if len(some)])


def test_what_a_fit_of_low_order_leaves_is_in_percent(samples):
    seen = mmbrdf.inspect(samples)
    _, axes = mmbrdf.plot.low_order_residuals(samples, inspection=seen)
    left = points(axes)[:, 1]
    assert np.sqrt(np.mean(left**2)) == pytest.approx(100 * seen.f11_residual, rel=0.1)
    assert "%" in axes.get_ylabel() and "theta" in axes.get_xlabel()


def test_another_wavelength_has_no_fit_of_low_order_and_no_empty_picture(ptfe):
    data = mmbrdf.simulate(ptfe, [351, 532], mmbrdf.random_geometries(100, seed=1), speckle=0.01, seed=2)
    seen = mmbrdf.inspect(data)
    _, axes = mmbrdf.plot.low_order_residuals(data, inspection=seen)
    assert np.isfinite(points(axes)).all() and len(points(axes)) == 100
    with pytest.raises(ValueError, match="^no fit of low order at 532 nm: it is at 351 nm, that of the first sample$"):
        mmbrdf.plot.low_order_residuals(data, 532, inspection=seen)


def test_samples_of_xy_that_are_given_as_sp_are_found_in_a_part_and_a_pickle_too(samples):
    wrong = mmbrdf.Dataset(samples.wavelength_nm, *samples.geometry, samples.mueller, frame="sp")
    for data in (wrong, wrong[:1500], pickle.loads(pickle.dumps(wrong))):
        assert [(one.fault, one.remedy) for one in mmbrdf.inspect(data).findings] == [("frame or signs", "--frame xy")]


def test_other_things_than_samples_are_refused_in_a_line(ptfe, samples):
    for draw in (mmbrdf.plot.directions, mmbrdf.plot.suspicious, mmbrdf.plot.low_order_residuals):
        with pytest.raises(TypeError, match=r"^plot\.\w+: data: expected mmbrdf.Dataset, not Model$"):
            draw(ptfe)
        with pytest.raises(TypeError, match="^inspection: expected mmbrdf.Inspection, not tuple$"):
            draw(samples, inspection=())
        with pytest.raises(ValueError, match="633"):
            draw(samples, 633)


# The page


def shown(page):
    """Its text, without pictures."""
    return html.unescape(re.sub("<[^>]*>", "\n", re.sub('src="data:[^"]*"', "", page)))


def test_the_page_says_what_the_program_says(faulty, tmp_path, program):
    faulty.save(tmp_path / "d.csv")
    mmbrdf.report(None, mmbrdf.load(tmp_path / "d.csv"), tmp_path / "page.html", data_name="d.csv")
    text = shown((tmp_path / "page.html").read_text())
    facts = json.loads(program("inspect", "d.csv", "--format", "json"))
    for one in facts["findings"] + facts["untested"]:
        assert all(words in text for words in one.values())
    assert facts["hole"] in text and facts["sides"] in text and len(facts["findings"]) == 2
    printed = program("inspect", "d.csv")
    assert printed.splitlines()[-1] == "mmbrdf fit d.csv -o model.json" and printed.splitlines()[-1] in text
    for line in printed.splitlines()[2:7]:
        assert line[13:] in text


def test_the_page_of_samples_without_a_fault_has_the_verdict_and_three_pictures(samples, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    page = _report.page(None, samples, data_name="d.csv")
    assert mmbrdf.inspect(samples).verdict in shown(page)
    assert len(re.findall('src="data:image/png', page)) == 3
    assert not re.search(r"https?://", re.sub(r'src="data:[^"]*"', "", page))
    assert page == _report.page(None, samples, data_name="d.csv")


def test_names_of_files_are_text_and_quoted_for_a_shell(samples):
    page = _report.page(None, samples[:100], data_name="<i>it's.csv")
    assert "<i>" not in page
    assert """mmbrdf fit '<i>it'"'"'s.csv' -o model.json""" in shown(page)
    assert "mmbrdf fit ./-d.csv -o" in shown(_report.page(None, samples[:100], data_name="-d.csv"))


def test_the_command_on_the_page_has_the_frame_that_mends_as_that_of_the_program(samples, tmp_path, program):
    samples.save(tmp_path / "d.csv")
    done = run_module("d.csv", "--frame", "sp", "-o", "page.html", folder=tmp_path)
    assert done.returncode == 0
    command = "mmbrdf fit d.csv --frame xy -o model.json"
    assert command in shown((tmp_path / "page.html").read_text())
    assert program("inspect", "d.csv", "--frame", "sp").splitlines()[-1] == command


def test_of_several_wavelengths_all_are_said_and_some_can_be_chosen(ptfe):
    data = mmbrdf.simulate(ptfe, [351, 532], mmbrdf.random_geometries(100, 1), speckle=0.01, seed=1)
    text = shown(_report.page(None, data))
    assert "351, 532 nm" in text and "351 nm: directions of the source" in text
    text = shown(_report.page(None, data, data_name="d.csv", wavelength_nm=532))
    assert "mmbrdf fit d.csv -w 532 -o model.json" in text and "351" not in text
    with pytest.raises(ValueError, match="633"):
        _report.page(None, data, wavelength_nm=633)


def test_neither_a_model_nor_samples_is_refused_in_a_line(tmp_path):
    with pytest.raises(TypeError, match="^model: expected mmbrdf.Model, not NoneType$"):
        mmbrdf.report(None, None, tmp_path / "page.html")
    assert list(tmp_path.iterdir()) == []


def test_samples_that_cannot_be_fitted_have_a_page_too(samples, tmp_path):
    samples[:9].save(tmp_path / "d.csv")
    lines = [line.split(",") for line in (tmp_path / "d.csv").read_text().splitlines()]
    fills = [lines[0], *(line[:5] + ["-999"] * (len(line) - 5) for line in lines[1:])]
    (tmp_path / "d.csv").write_text("\n".join(map(",".join, fills)) + "\n")
    text = shown(_report.page(None, mmbrdf.load(tmp_path / "d.csv")))
    assert "fill values" in text and "no fit" in text and "there is no fit" in text


def run_module(*arguments, folder):
    command = [sys.executable, "-m", "mmbrdf.report", *map(str, arguments)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_a_file_of_samples_alone_makes_the_page(samples, tmp_path):
    samples.save(tmp_path / "d.csv")
    done = run_module("d.csv", "-o", "page.html", folder=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert "d.csv: 1824 samples" in (tmp_path / "page.html").read_text()
    (tmp_path / "aoi.csv").write_text((tmp_path / "d.csv").read_text().replace("theta_i_deg", "AOI"))
    done = run_module("aoi.csv", "--columns", "theta_i_deg=AOI", "--frame", "xy", "-o", "page.html", folder=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert "mmbrdf fit aoi.csv --columns theta_i_deg=AOI --frame xy -o" in (tmp_path / "page.html").read_text()
    (tmp_path / "bad.csv").write_text((tmp_path / "d.csv").read_text().replace("theta_r_deg", "other"))
    for arguments, message in (
        (("bad.csv", "-o", "other.html"), "bad.csv:1: no column theta_r_deg"),
        (("d.csv", "d.csv", "-o", "other.html"), "d.csv: expected a model"),
        (("d.csv", "-w", "633", "-o", "other.html"), "633"),
        (("d.csv", "-o", "d.csv", "--format", "html"), "would overwrite"),
    ):
        done = run_module(*arguments, folder=tmp_path)
        assert done.returncode == 1 and message in done.stderr and done.stderr.count("\n") == 1
    assert not (tmp_path / "other.html").exists()
