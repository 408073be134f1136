# SPDX-License-Identifier: BSD-3-Clause
"""What was not measured is nan, in data and in models."""

import pickle
import re

import numpy as np
import pytest

import mmbrdf

GEOMETRY = (45, 0, 30, 120)


@pytest.fixture(scope="module")
def nine():
    """The elements of linear states."""
    data = mmbrdf.simulate(mmbrdf.material("ptfe-532"), 532, mmbrdf.random_geometries(300, seed=1), speckle=0.006)
    mueller = data.mueller.copy()
    mueller[:, 3, :] = mueller[:, :, 3] = np.nan
    g = data.geometry
    return mmbrdf.Dataset(532, *g, mueller)


def test_elements_are_unknown_in_a_model_and_in_all_that_is_asked_of_it(nine):
    model = mmbrdf.fit(nine).model
    assert model.not_measured == ["14", "24", "34", "41", "42", "43", "44"]
    unknown = np.zeros((4, 4), bool)
    unknown[3, :] = unknown[:, 3] = True
    for frame in ("xy", "sp", "scattering_plane"):
        assert np.array_equal(np.isnan(model.evaluate(532, *GEOMETRY, frame=frame)), unknown)
        u = model.evaluate_uncertainty(532, *GEOMETRY, frame=frame)
        assert np.array_equal(np.isnan(u), unknown)
    assert np.isnan(mmbrdf.model_diagnostics(model).margin)
    assert "44" not in mmbrdf.compare(model, nine).normalized


def test_elements_leave_no_picture_of_what_needs_them_and_no_gap_in_a_report(nine, tmp_path):
    model = mmbrdf.fit(nine, orders=(4, 3)).model
    mmbrdf.report(model, nine, tmp_path / "nine.html")
    assert (tmp_path / "nine.html").read_text().count('<figure class="picture">') > 2
    mmbrdf.plot.in_plane_curves(model, 532)
    with pytest.raises(ValueError, match="^not measured, and needed here: 14, 24"):
        mmbrdf.plot.realizability_map(model, 532, 45)
    scalar = nine.mueller.copy()
    scalar[:, :, 1:] = scalar[:, 1:, :] = np.nan
    model = mmbrdf.fit(mmbrdf.Dataset(532, *nine.geometry, scalar), orders=(4, 3)).model
    mmbrdf.report(model, None, tmp_path / "f11.html")
    with pytest.raises(ValueError, match="^not measured, and needed here: "):
        mmbrdf.plot.depolarization_map(model, 532, 45)


def test_elements_leave_the_uncertainties_that_are_drawn_of_what_does_not_need_them(nine):
    known = nine.mueller.copy()
    known[:, 3, :] = known[:, :, 3] = 0  # each block is fitted by itself
    model, whole = (
        mmbrdf.fit(mmbrdf.Dataset(532, *nine.geometry, mueller), orders=(2, 1), uncertainty="noise").model
        for mueller in (nine.mueller, known)
    )
    for name in ("11", "reflectance_factor", "22", "f_sp"):
        u, expected = (mmbrdf.plot.map(one, name, 532, 45, show="u", samples=5)[1].images[0] for one in (model, whole))
        np.testing.assert_allclose(np.ma.filled(u.get_array(), -1), np.ma.filled(expected.get_array(), -1), rtol=1e-9)


def test_elements_are_not_written_and_are_missing_when_read_again(nine, tmp_path):
    nine.save(tmp_path / "nine.csv")
    header = (tmp_path / "nine.csv").read_text().splitlines()[0]
    assert header.endswith(",f11,m12,m13,m21,m22,m23,m31,m32,m33")
    again = mmbrdf.read_samples(tmp_path / "nine.csv")
    assert np.array_equal(again.normalized, nine.normalized, equal_nan=True)


def test_f11_must_be_there():
    mueller = np.full((4, 4), np.nan)
    with pytest.raises(ValueError, match="M11 = nan"):
        mmbrdf.Dataset(532, 45, 0, 30, 180, mueller)


def test_a_data_set_says_in_which_frame_its_samples_were_measured(ptfe, tmp_path):
    geometry = (45, 10, [20, 30, 40], [50, 60, 70])
    f = ptfe.evaluate(532, *geometry, frame="sp")
    f[:2, 2:] = f[:2, :, 2:] = np.nan  # s and p alone; the last is whole
    data = mmbrdf.Dataset(532, *geometry, f, frame="sp")
    data.save(tmp_path / "data.csv")
    for same in (data, pickle.loads(pickle.dumps(data)), mmbrdf.load(tmp_path / "data.csv"), data.at_wavelengths(532)):
        assert same.frame.tolist() == ["sp", "sp", "xy"]
        assert same[1:].frame.tolist() == ["sp", "xy"]
        np.testing.assert_allclose(same.as_measured[:2], f[:2] / f[:2, :1, :1], rtol=0, atol=1e-14)
        np.testing.assert_array_equal(same.as_measured[2], same.normalized[2])
        assert np.isnan(same.normalized[0, 0, 1])  # which 13 would be needed for
        assert re.search(r"^  frame +sp \(2 samples\), xy \(1 sample\)$", same.summary(), re.MULTILINE)
        assert "12" not in re.search("not measured(.*)", same.summary())[1]
    assert re.search(r"^  frame +sp$", data[:2].summary(), re.MULTILINE)
    assert "frame" not in data[2].summary() and data[[]].frame.shape == (0,)
