# SPDX-License-Identifier: BSD-3-Clause
"""Choosing, judging and comparing fits: the numbers of the program's select, subsets, compare and report."""

import csv
import io
import json
import pickle
import re
import warnings

import numpy as np
import pytest

import mmbrdf

CURVES = ("ss", "sp", "ps", "pp")


@pytest.fixture(scope="module")
def ring():
    """1200 samples at 532 nm, mirror images among them, that two azimuths and five angles of the source have."""
    theta_i, phi_i, theta_r, turn = (
        axis.ravel()
        for axis in np.meshgrid([0, 15, 30, 45, 60], [0, 40], [10, 25, 40, 55, 70], np.arange(7.5, 360, 15))
    )
    lot = np.random.default_rng(1).permutation(len(turn))  # else each third would have a third of the azimuths
    geometry = (theta_i[lot], phi_i[lot], theta_r[lot], (phi_i + turn)[lot])
    return mmbrdf.simulate(mmbrdf.material("ptfe"), 532, geometry, speckle=0.01, seed=3)


@pytest.fixture
def told(ring, program, tmp_path):
    """Runs a command of the program on those samples in data.csv, and reads the JSON that it prints."""
    ring.save(tmp_path / "data.csv")
    return lambda *command: json.loads(program(*command, "--format", "json"))


def as_program_tells(candidate):
    """A Candidate as a row of `mmbrdf select --format json`."""
    row = candidate._asdict()
    row["cross_validation"] = {
        kind: {"rms": None, "undetermined": held.undetermined} if held.undetermined else held._asdict()
        for kind, held in candidate.cross_validation.items()
    }
    for held in row["cross_validation"].values():
        if held["rms"] is not None:
            del held["undetermined"]
    return row


def test_a_selection_is_that_of_the_program(ring, told):
    for options, arguments in (
        ({"orders_f11": (3, 6)}, ("--orders-f11", "3:6")),
        ({"basis": "anisotropic", "leave_out": "none", "folds": 4}, ("--basis", "anisotropic", "--leave-out", "none", "--folds", 4)),
        ({"orders_f11": (4, 5), "orders_other": (3, 3), "random_folds": True, "seed": 7, "weights": "speckle", "leave_out": "angle"},
         ("--orders-f11", "4:5", "--orders-other", "3", "--random-folds", "--seed", 7, "--weights", "speckle", "--leave-out", "angle")),
    ):  # fmt: skip
        here, there = mmbrdf.select(ring, **options), told("select", "data.csv", *arguments)
        for part in ("f11", "other"):
            assert [as_program_tells(one) for one in getattr(here, part)] == there[part]
        assert (list(here.orders), here.powers) == (there["recommended_orders"], there["recommended_powers"])
        assert (here.reason_f11, here.reason_other) == (there["reason_f11"], there["reason_other"])
        assert repr(here).startswith(f"<mmbrdf.Selection: orders {here.orders}, powers 0; f11: order ")
        assert pickle.loads(pickle.dumps(here)) == here


def test_a_selection_says_what_it_could_not_leave_out(ptfe):
    data = mmbrdf.simulate(ptfe, 532, mmbrdf.random_geometries(300, seed=1), speckle=0.01)
    choice = mmbrdf.select(data, orders_f11=(2, 3), orders_other=(1, 2))
    assert list(choice.f11[0].cross_validation) == ["rows"]
    assert "folds alone decide" in choice.note and choice.note in repr(choice)
    none = mmbrdf.select(data[:8], orders_f11=(9, 9), orders_other=(6, 6))
    assert none.orders is None and none.powers is None and none.f11[0].refused
    assert repr(none).startswith("<mmbrdf.Selection: no recommendation; f11: every order is refused")
    for wrong, message in (
        ({"leave_out": "day"}, '"day": expected angle, wavelength'),
        ({"leave_out": "wavelength"}, "leaving out each of the wavelengths: the data have 1"),
        ({"folds": 1}, "folds: 1 is not in 2...100"),
        ({"orders_f11": (4, 3)}, "orders of f11 4 to 3"),
        ({"basis": "fourier"}, "fourier"),
    ):
        with pytest.raises(ValueError, match=message):
            mmbrdf.select(data, **wrong)


def test_subsets_are_those_of_the_program(ring, told, program):
    for options, arguments in (
        ({}, ()),
        ({"splits": 3, "seed": 5, "k": 2, "orders": (5, 3), "weights": "speckle"},
         ("--splits", 3, "--seed", 5, "--k", 2, "--orders", "5,3", "--weights", "speckle")),
        ({"reference": mmbrdf.material("ptfe-532"), "theta_i_deg": 30, "theta_r_deg": [-20, 0, 20], "random": True},
         ("--reference", "ptfe-532", "--theta-i", 30, "--range=-20:20:20", "--random")),
    ):  # fmt: skip
        here, there = mmbrdf.subsets(ring, **options), told("subsets", "data.csv", *arguments)
        assert (here.observed, here.predicted, len(here.theta_r_deg)) == (
            there["observed"],
            there["predicted"],
            there["angles"],
        )
        for split, row in zip(here.splits, there["splits"], strict=True):
            assert {name: getattr(split, name) for name in row} == row
        assert f"{len(here.splits)} split" in repr(here) and f"{100 * here.observed:.4g} %" in repr(here)


def test_the_curves_of_subsets_are_those_of_the_program(ring, told, program):
    told("subsets", "data.csv")  # writes the samples
    rows = list(csv.DictReader(io.StringIO(program("subsets", "data.csv", "--format", "csv"))))
    here = mmbrdf.subsets(ring)
    (split,) = here.splits
    for at, row in enumerate(rows):
        found = {"theta_r_deg": here.theta_r_deg[at]}
        for name in CURVES:
            of = lambda curve: getattr(curve, name)[at]
            found |= {f"f_{name}_{k}": of(curve) for k, curve in enumerate(split.curves, 1)}
            found |= {f"f_{name}_mean": of(split.mean), f"s_f_{name}": of(split.deviation)}
            found |= {f"u_f_{name}": of(split.uncertainty), f"f_{name}_reference": of(split.reference)}
        assert found == {name: float(value) for name, value in row.items()}


def test_subsets_that_cannot_be_had_are_refused(ring, ptfe):
    both = mmbrdf.simulate(ptfe, [351, 532], ring.geometry, speckle=0.01)
    with pytest.raises(ValueError, match="wavelength_nm: needed, since the data have samples at 351, 532 nm"):
        mmbrdf.subsets(both)
    assert mmbrdf.subsets(both, wavelength_nm=532, orders=(3, 2)).predicted > 0
    for wrong, message in (
        ({"k": 1}, "folds: 1 is not in 2...100"),
        ({"splits": 0}, "splits: 0 is not in 1...10000"),
        ({"theta_i_deg": 95}, "theta_i = 95 degrees, must be in 0...90"),
        ({"as_printed": True}, "as_printed goes with germer2017"),
    ):
        with pytest.raises(ValueError, match=message):
            mmbrdf.subsets(ring, **wrong)
    with pytest.warns(mmbrdf.ExtrapolationWarning, match="the samples: 1 of 2 questions lies outside the fitted range"):
        mmbrdf.subsets(ring, theta_r_deg=[60, 80])


def report_place(geometry):
    """As the report writes it."""
    turn = geometry.phi_r_deg - geometry.phi_i_deg
    return f"theta_i {geometry.theta_i_deg:.4g}, theta_r {geometry.theta_r_deg:.4g}, phi_r - phi_i {turn:.4g} degrees"


def test_diagnostics_are_those_of_the_report(ring, told):
    there = told("report", "ptfe-532", "data.csv")
    model = mmbrdf.material("ptfe-532")
    tests = mmbrdf.symmetry_tests(ring, model.orders)
    names = ("block", "rows", "more_coefficients", "rms", "rms_without", "F", "p")
    for field, here in (
        ("reciprocity", tests.reciprocity),
        ("mirror_symmetry", tests.mirror),
        ("dependence_on_phi_i", tests.azimuth),
    ):
        found = [(t.block, t.rows, t.extra, t.rms, t.rms_extended, t.f, t.p) for t in here]
        assert [dict(zip(names, one, strict=True)) for one in found] == there[field]
    assert not tests.one_azimuth and mmbrdf.symmetry_tests(ring[ring.phi_i_deg == 0], (3, 2)).one_azimuth

    result = mmbrdf.fit(ring, orders=model.orders, minimum_norm=True, uncertainty="noise")
    diagnostics = mmbrdf.sample_diagnostics(result, ring)
    for here, row in zip(diagnostics.leverage, there["leverage"], strict=True):
        assert (here.block, here.rank, here.values[here.largest]) == (
            row["block"],
            row["rank"],
            row["largest_leverage"],
        )
        assert here.largest + 1 == row["sample"] and here.values.sum() == pytest.approx(here.rank, rel=1e-9)
    rows = [(row["sample"] - 1, row["element"], row["studentized"]) for row in there["outliers"]]
    assert [tuple(one) for one in mmbrdf.outliers(diagnostics)][: len(rows)] == rows
    assert mmbrdf.outliers(diagnostics, 3)[0].studentized == pytest.approx(
        diagnostics.studentized.flat[np.abs(diagnostics.studentized).argmax()]
    )


def test_where_a_model_is_not_physical_is_told_as_in_the_report(told):
    model = mmbrdf.material("ptfe-532")
    there = told("report", "ptfe-532")["realizability"]
    for row in there:
        d = mmbrdf.model_diagnostics(model, theta_max_deg=row["theta_max_deg"])
        assert d.wavelength_nm == row["wavelength_nm"] and d.geometries == row["geometries"]
        assert (d.unrealizable, d.margin, d.f11) == (row["unrealizable"], row["smallest_margin"], row["smallest_f11"])
        assert report_place(d.margin_at) == row["margin_at"] and d.not_positive_f11 == row["f11_not_positive"]
        assert (d.dhr, d.dhr_theta_i_deg) == (row["largest_dhr"], row["dhr_at_theta_i_deg"])
        with pytest.warns(mmbrdf.ExtrapolationWarning):  # it is at the edge
            margin = mmbrdf.realizability_margin(model.evaluate(532, *d.margin_at))
        assert margin == pytest.approx(d.margin, rel=1e-9)
    with pytest.raises(ValueError):
        mmbrdf.model_diagnostics(model, theta_max_deg=100)


def test_mirror_pairs_say_how_much_noise_there_is(ring):
    found = mmbrdf.mirror_pairs(ring)
    assert found.pairs == 480  # at normal incidence there is no plane of incidence
    assert found.rms[0, 0] == pytest.approx(0.01, rel=0.3)
    assert np.abs(found.mean).max() < 5 * 0.02 / np.sqrt(2 * found.pairs)
    assert mmbrdf.mirror_pairs(ring[:1]).pairs == 0


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


@pytest.mark.parametrize("weights", ["none", "speckle", "estimated"])
def test_leverages_add_up_to_the_rank_whatever_the_weights(weights, ptfe):
    data = mmbrdf.simulate(ptfe, 532, mmbrdf.random_geometries(400, seed=3), speckle=0.02, seed=4)
    result = mmbrdf.fit(data, orders=(4, 2), weights=weights)
    for block in mmbrdf.sample_diagnostics(result, data).leverage:
        assert block.values.sum() == pytest.approx(block.rank, abs=1e-8)
