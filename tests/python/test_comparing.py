# SPDX-License-Identifier: BSD-3-Clause
"""Comparing models and samples: the numbers of the program's compare."""

import re
import warnings

import numpy as np
import pytest

import mmbrdf


def test_a_comparison_is_that_of_the_program(ring, told):
    first, second = mmbrdf.material("ptfe"), mmbrdf.material("ptfe-532")
    for here, command in (
        (mmbrdf.compare(first, ring), ("ptfe", "data.csv")),
        (mmbrdf.compare(first, second), ("ptfe", "ptfe-532")),
        (mmbrdf.compare(second, first, [351, 532], mmbrdf.random_geometries(200, seed=3)),
         ("ptfe-532", "ptfe", "-w", "351,532", "--grid", "random:200", "--seed", 3)),
    ):  # fmt: skip
        there = told("compare", *command)
        same = 1e-12 if "--grid" in command else 0  # directions that were in degrees have other last bits
        found = [here.samples, here.polarization_rms, here.largest.largest]
        assert found == pytest.approx([there[name] for name in ("samples", "rms_polarization", "largest")], rel=same)
        for difference, row in zip(
            (here.f11, here.f11_relative, *here.normalized.values()), there["elements"], strict=True
        ):
            assert difference == pytest.approx([row[name] for name in difference._fields], rel=same, abs=same)
        assert list(here.normalized) == [row["element"] for row in there["elements"][2:]]
        assert repr(here).startswith(f"<mmbrdf.Comparison: {here.samples} samples, rms of f11 ")


def test_samples_beyond_the_fitted_range_are_left_out_as_by_the_program(ptfe, told, tmp_path):
    geometry = mmbrdf.random_geometries(400, seed=5, theta_max_deg=89)
    mmbrdf.simulate(ptfe, [532, 633], geometry, speckle=0.01).save(tmp_path / "wide.csv")
    wide = mmbrdf.load(tmp_path / "wide.csv")
    for options, command in (({}, ()), ({"theta_max_deg": 90}, ("--theta-max", 90)), ({"theta_max_deg": 40.5}, ("--theta-max", 40.5)),
                             ({"wavelength_nm": 633}, ("-w", 633))):  # fmt: skip
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            here = mmbrdf.compare(ptfe, wide, **options)
        there = told("compare", "ptfe", "wide.csv", *command)
        assert (here.samples, here.largest.largest) == (there["samples"], there["largest"])
        assert all(one.category is mmbrdf.ExtrapolationWarning and one.filename == __file__ for one in caught)
        said = [re.sub(r"\d+", "N", str(one.message)) for one in caught]
        assert (
            said
            == {
                "": ["N of N samples beyond the fitted range are left out: theta_max_deg=N takes all"],
                "90": ["ptfe: N of N samples lie outside the fitted range (theta_i+theta_r+directions)"],
                "40.5": [],
            }[str(options.get("theta_max_deg", ""))]
        )


@pytest.fixture(scope="module")
def narrow_at_633(ptfe):
    """A fit to 80 degrees at 532 nm, and to 30 at 633."""
    data = mmbrdf.simulate(ptfe, [532, 633], mmbrdf.random_geometries(600, seed=1, theta_max_deg=80), speckle=0.01)
    near = np.maximum(data.theta_i_deg, data.theta_r_deg) < 30
    return mmbrdf.fit(data[(data.wavelength_nm == 532) | near], orders=(3, 2)).model


@pytest.mark.filterwarnings("ignore::mmbrdf.ExtrapolationWarning")
def test_a_direction_is_left_out_at_the_wavelengths_at_which_it_was_not_fitted(narrow_at_633, ptfe, told, tmp_path):
    narrow_at_633.save(tmp_path / "narrow.json")
    wide = mmbrdf.simulate(ptfe, [532, 633], mmbrdf.random_geometries(300, seed=5, theta_max_deg=75), speckle=0.01)
    wide.save(tmp_path / "wide.csv")
    wide = mmbrdf.load(tmp_path / "wide.csv")
    assert mmbrdf.compare(narrow_at_633, wide, 633).samples < 100 < mmbrdf.compare(narrow_at_633, wide, 532).samples
    for other, name in ((wide, "wide.csv"), (ptfe, "ptfe")):
        here, there = mmbrdf.compare(narrow_at_633, other), told("compare", "narrow.json", name)
        found = [here.samples, here.polarization_rms, here.largest.largest]
        assert found == pytest.approx([there[one] for one in ("samples", "rms_polarization", "largest")], rel=1e-12)
        if other is wide:
            continue
        rows = {row["element"]: row for row in there["elements"] if (row["element"], row["unit"]) != ("11", "f11")}
        assert here.significance.keys() == rows.keys()
        for name, one in here.significance.items():
            expected = [rows[name][field] for field in ("mean_over_u", "largest_over_u", "within_95")]
            assert [one.mean, one.largest, one.within] == pytest.approx(expected, rel=1e-9)


def test_two_models_that_are_compared_beyond_their_fits_warn(ptfe):
    first, second = ptfe, mmbrdf.material("ptfe-532")
    for options in (
        {"theta_max_deg": 90, "geometry": mmbrdf.in_plane(30, [0, 89])},
        {"geometry": mmbrdf.in_plane(30, [0, 89])},
    ):
        with pytest.warns(mmbrdf.ExtrapolationWarning) as warned:
            mmbrdf.compare(first, second, 532, **options)
        assert [str(one.message) for one in warned] == [
            f"{name}: 1 of 2 samples lies outside the fitted range (theta_r)" for name in ("ptfe", "ptfe-532")
        ]
        assert {one.filename for one in warned} == {__file__}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mmbrdf.compare(first, second, 532)


def test_two_models_are_compared_as_far_as_it_is_said(told):
    first, second = mmbrdf.material("ptfe"), mmbrdf.material("ptfe-532")
    for options, command in (
        ({"theta_max_deg": 30}, ("--theta-max", 30)),
        ({"theta_max_deg": 90}, ("--theta-max", 90)),
    ):
        there = told("compare", "ptfe", "ptfe-532", *command)
        assert mmbrdf.compare(first, second, **options).samples == there["samples"]
    near = mmbrdf.in_plane(30, [0, 20, 60])
    assert mmbrdf.compare(first, second, geometry=near, theta_max_deg=30).samples == 2
    for wrong, message in (
        (0, "theta_max_deg = 0: must be in (0, 90] degrees"),
        (95, "theta_max_deg = 95: must be in"),
    ):
        with pytest.raises(ValueError, match=re.escape(message)):
            mmbrdf.compare(first, second, theta_max_deg=wrong)
    with pytest.raises(ValueError, match="^theta_max_deg = 1: no geometry is within$"):
        mmbrdf.compare(first, second, geometry=near, theta_max_deg=1)


def test_two_data_sets_that_share_no_wavelength_are_said_to(ptfe):
    grid = mmbrdf.random_geometries(300, seed=3)
    one, other = (mmbrdf.simulate(ptfe, nm, grid, speckle=0.02) for nm in ([351, 532], [633, 1064]))
    with pytest.raises(
        ValueError,
        match="^the samples have no wavelength in common: they are at 351, 532 nm and 633, 1064 nm$",
    ):
        mmbrdf.compare(one, other)


def test_two_data_sets_are_fitted_at_the_wavelengths_that_are_asked_for(ptfe, told, tmp_path):
    grid = mmbrdf.random_geometries(400, seed=3)
    names = []
    for seed in (1, 2):
        mmbrdf.simulate(ptfe, [532, 633], grid, speckle=0.02, seed=seed).save(tmp_path / f"{seed}.csv")
        names.append(f"{seed}.csv")
    here = mmbrdf.compare(*(mmbrdf.load(tmp_path / name) for name in names), 633)
    there = told("compare", *names, "-w", 633)
    assert (here.samples, here.largest.largest) == pytest.approx((there["samples"], there["largest"]), rel=1e-12)


def test_two_models_differ_by_so_many_uncertainties(ring, told, ptfe):
    first, second = mmbrdf.material("ptfe"), mmbrdf.material("ptfe-532")
    found, there = mmbrdf.compare(first, second).significance, told("compare", "ptfe", "ptfe-532")
    rows = [row for row in there["elements"] if (row["element"], row["unit"]) != ("11", "f11")]
    for row in rows:
        one = found[row["element"]]
        assert (one.mean, one.largest, one.within) == pytest.approx(
            [row["mean_over_u"], row["largest_over_u"], row["within_95"]]
        )
    assert mmbrdf.compare(first, ring).significance is None
    assert mmbrdf.compare(mmbrdf.in_published_form(first), first).significance is None  # it has no covariance


def test_two_data_sets_are_compared_by_their_fits(ptfe):
    grid = mmbrdf.random_geometries(400, seed=3)
    one, other = (mmbrdf.simulate(ptfe, 532, grid, speckle=0.02, seed=s) for s in (1, 2))
    found = mmbrdf.compare(one, other)
    fits = [mmbrdf.fit(data).model for data in (one, other)]
    assert found == mmbrdf.compare(*fits)
    assert found.significance["11"].within > 0.5
    with pytest.raises(ValueError, match="samples; beside a model they are the second argument"):
        mmbrdf.compare(one, ptfe)


def test_what_cannot_be_compared_is_refused(ring, ptfe):
    with pytest.raises(ValueError, match="geometry: goes with two models"):
        mmbrdf.compare(ptfe, ring, geometry=mmbrdf.germer2017_grid())
    with pytest.raises(ValueError, match="wavelength_nm: needed, since there is none of which both models say"):
        mmbrdf.compare(mmbrdf.material("ptfe-351"), mmbrdf.material("ptfe-532"))
    for nothing in (None, 3, "ptfe"):
        with pytest.raises(TypeError):
            mmbrdf.compare(ptfe, nothing)
