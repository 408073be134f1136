# SPDX-License-Identifier: BSD-3-Clause
"""Comparing models and samples: the numbers of the program's compare."""

import json
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
                "90": [
                    "ptfe: N of N samples lie outside the fitted range (theta_i+theta_r+directions): fitted are theta_i <= N, "
                    "theta_r <= N.N degrees at N, N, N, N nm"
                ],
                "40.5": [],
            }[str(options.get("theta_max_deg", ""))]
        )


def over_u(one):
    return [one.u, one.rms, one.mean, one.largest, one.within, one.beyond]


def as_program_has_it(row):
    """The same of an element in `mmbrdf compare --format json`."""
    fields = ("u_difference", "rms_over_u", "mean_over_u", "largest_over_u", "within_95", "beyond_2u")
    return [row[field] for field in fields]


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
            assert over_u(one) == pytest.approx(as_program_has_it(rows[name]), rel=1e-9)


def test_two_models_that_are_compared_beyond_their_fits_warn(ptfe):
    first, second = ptfe, mmbrdf.material("ptfe-532")
    for options in (
        {"theta_max_deg": 90, "geometry": mmbrdf.in_plane(30, [0, 89])},
        {"geometry": mmbrdf.in_plane(30, [0, 89])},
    ):
        with pytest.warns(mmbrdf.ExtrapolationWarning) as warned:
            mmbrdf.compare(first, second, 532, **options)
        assert [str(one.message).partition(": fitted are")[0] for one in warned] == [
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
        assert over_u(found[row["element"]]) == pytest.approx(as_program_has_it(row), rel=1e-9)
    assert mmbrdf.compare(first, ring).significance is None
    assert mmbrdf.compare(mmbrdf.in_published_form(first), first).significance is None  # it has no covariance


def measured(ptfe, geometry, seed):
    """Samples that know their noise of 1 %."""
    samples = mmbrdf.simulate(ptfe, 532, geometry, speckle=0.01, seed=seed)
    u = np.full((len(samples), 4, 4), 0.01)
    u[:, 0, 0] *= samples.f11
    return mmbrdf.Dataset(samples.wavelength_nm, *samples.geometry, samples.mueller, uncertainty=u)


def test_samples_differ_from_a_model_by_so_many_uncertainties_and_terms_add_to_them(ptfe, program, tmp_path):
    samples = measured(ptfe, mmbrdf.random_geometries(200, seed=4, theta_max_deg=60), 1)
    samples.save(tmp_path / "known.csv")
    for terms, arguments in (
        (None, ()),
        ({"scale": 0.003, "theta_r_deg": 0.02}, ("--term", "scale=0.3%", "--term", "theta_r=0.02deg")),
    ):
        there = json.loads(program("compare", "ptfe", "known.csv", *arguments, "--format", "json"))
        found = mmbrdf.compare(ptfe, samples, terms=terms).significance
        rows = {row["element"]: row for row in there["elements"] if (row["element"], row["unit"]) != ("11", "f11")}
        assert found.keys() == rows.keys()
        for name, row in rows.items():
            assert over_u(found[name]) == pytest.approx(as_program_has_it(row), rel=1e-9)
    more = mmbrdf.compare(ptfe, samples, terms={"scale": 0.01}).significance
    assert more["11"].u > found["11"].u and more["22"].u < found["22"].u  # a ratio has no scale


def test_samples_are_set_beside_samples_as_by_the_program(ptfe, program, tmp_path):
    theta_r = np.arange(10, 71, 5)
    monday = measured(ptfe, (30, 0, theta_r, 160), 1)
    friday = measured(ptfe, (30, 0, theta_r, np.where(theta_r % 10, -160.05, 160.05)), 2)
    names = ("monday.csv", "friday.csv")
    for data, name in zip((monday, friday), names):
        data.save(tmp_path / name)
    for options, arguments, pairs, images in (
        ({"match_deg": 0.1}, ("--match", 0.1), 7, 0),
        ({"match_deg": 0.1, "partners": ["mirror"]}, ("--match", 0.1, "--partners", "mirror"), 13, 6),
        ({"match_deg": 0.1, "theta_max_deg": 45}, ("--match", 0.1, "--theta-max", 45), 4, 0),
    ):
        here = mmbrdf.compare(monday, friday, **options)
        there = json.loads(program("compare", *names, *arguments, "--format", "json"))
        assert (here.samples, here.images) == (pairs, images)
        assert (here.samples, here.largest.largest) == pytest.approx((there["samples"], there["largest"]), rel=1e-9)
        rows = {row["element"]: row for row in there["elements"] if (row["element"], row["unit"]) != ("11", "f11")}
        assert here.significance.keys() == rows.keys()
        for name, one in here.significance.items():
            assert over_u(one) == pytest.approx(as_program_has_it(rows[name]), rel=1e-9)
    bare = mmbrdf.simulate(ptfe, 532, monday.geometry)
    assert mmbrdf.compare(bare, friday, match_deg=0.1).significance is None


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"match_deg": 0.1, "terms": {"scale": 0.01}}, "match_deg: samples beside samples have no geometry, as_printed or terms"),
        ({"match_deg": 0.1, "partners": ["twin"]}, "partners: 'twin', expected 'mirror' or 'reciprocal'"),
        ({"match_deg": 6}, "match_deg: a tolerance of 6 degrees, must be in (0, 5]"),
        ({"partners": ["mirror"]}, "partners: go with match_deg"),
        ({"match_deg": 0.1, "wavelength_nm": 532}, "no sample of other is within 0.1 degrees of one of model: without match_deg their fits are compared"),
    ],
)  # fmt: skip
def test_what_cannot_be_matched_is_refused(ptfe, wrong, message):
    one, other = (mmbrdf.simulate(ptfe, 532, mmbrdf.in_plane(30, [angle])) for angle in (0, 10))
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        mmbrdf.compare(one, other, **wrong)
    with pytest.raises(ValueError, match="^match_deg: goes with two Datasets$"):
        mmbrdf.compare(ptfe, one, match_deg=0.1)


def test_terms_need_the_uncertainties_of_both(ptfe, ring):
    bare = mmbrdf.in_published_form(mmbrdf.material("ptfe-532"))
    for pair, unknown in (((ptfe, ring), "other"), ((bare, ptfe), "model")):
        with pytest.raises(
            ValueError, match=f"^terms: need uncertainties of both, and those of {unknown} are not known$"
        ):
            mmbrdf.compare(*pair, 532, terms={"scale": 0.003})


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
