# SPDX-License-Identifier: BSD-3-Clause
"""Choosing and judging fits: the numbers of the program's select, subsets and report."""

import csv
import io
import pickle

import numpy as np
import pytest

import mmbrdf

CURVES = ("ss", "sp", "ps", "pp")


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


@pytest.mark.parametrize("weights", ["none", "speckle", "estimated"])
def test_leverages_add_up_to_the_rank_whatever_the_weights(weights, ptfe):
    data = mmbrdf.simulate(ptfe, 532, mmbrdf.random_geometries(400, seed=3), speckle=0.02, seed=4)
    result = mmbrdf.fit(data, orders=(4, 2), weights=weights)
    for block in mmbrdf.sample_diagnostics(result, data).leverage:
        assert block.values.sum() == pytest.approx(block.rank, abs=1e-8)
