# SPDX-License-Identifier: BSD-3-Clause
"""What a measurement will tell: the numbers are the library's, as the program prints them."""
import csv
import io
import os
import subprocess

import numpy as np
import pytest

import mmbrdf
import mmbrdf.plot


def scan():
    return mmbrdf.in_plane(45, np.arange(-60, 61, 5.0))


def program(tmp_path, *options):
    with open(tmp_path / "scan.csv", "w", encoding="utf-8") as file:
        file.write("theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg\n")
        for row in zip(*np.broadcast_arrays(*scan())):
            file.write(",".join(repr(float(angle)) for angle in row) + "\n")
    command = [os.environ["MMBRDF_PROGRAM"], "plan", str(tmp_path / "scan.csv"), "--format", "csv", *options]
    table = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return list(csv.reader(io.StringIO(table)))


def test_is_what_the_program_prints(tmp_path):
    head, *rows = program(tmp_path, "--target", "dhr:8,45", "--target", "f:0:45", "--noise", "0.01")
    plan = mmbrdf.plan({"scan": scan()}, noise=0.01, targets=["dhr:8,45", "f:0:45"])
    assert plan.targets == tuple(name.removeprefix("expected_u_") for name in head[2:])
    assert plan.u.tolist() == [[float(u) for u in row[2:]] for row in rows]
    assert plan.readings == (25, 25, 25)
    assert "dhr_8" in repr(plan) and plan.designs[0] in repr(plan)


def test_turning_the_sample_is_worth_more_than_as_many_readings():
    grid = mmbrdf.germer2017_grid()
    u = mmbrdf.plan({"grid": grid}).u
    assert np.all(u[1] < u[0]) and u[1, 0] < u[0, 0] / 3  # every second one turned, f11


def test_choosing_lowers_what_is_asked_for():
    candidates = mmbrdf.random_geometries(60, seed=1)
    picks = mmbrdf.choose(12, candidates, design=scan(), targets=["dhr:30"])
    assert picks.shape == (12,) and picks.min() >= 0 and picks.max() < 60
    start = np.broadcast_arrays(*scan())

    def u_of(some):
        more = [np.append(a, np.asarray(b)[some]) for a, b in zip(start, candidates)]
        return mmbrdf.plan({"all": more}, targets=["dhr:30"]).u[0, -1]

    assert u_of(picks) < u_of(np.arange(12)) < mmbrdf.plan({"scan": scan()}, targets=["dhr:30"]).u[0, -1]


def test_a_fit_lends_its_variances_and_its_noise():
    data = mmbrdf.simulate(
        mmbrdf.material("ptfe-532"), 532, mmbrdf.random_geometries(200, seed=2), speckle=0.02, seed=3
    )
    like = mmbrdf.fit(data).model
    assert np.any(mmbrdf.plan({"scan": scan()}, like=like).u != mmbrdf.plan({"scan": scan()}).u)
    many = {"many": mmbrdf.random_geometries(200, seed=4)}
    noisy, quiet = (mmbrdf.plan(many, like=like, noise=noise).u for noise in (0.02, 0.002))
    assert np.all(quiet < noisy)
    with pytest.raises(ValueError, match="like: it was fitted at 532 nm, not at 600 nm"):
        mmbrdf.plan({"scan": scan()}, like=like, wavelength_nm=600)


def test_refuses_what_no_plan_is_made_of():
    for arguments, words in (
        ({"designs": {}}, "designs: none given"),
        ({"designs": {"a": scan()}, "targets": ["bhr"]}, "target 'bhr': expected dhr:THETA"),
        ({"designs": {"a": scan()}, "noise": 9e-7}, "noise 9e-07: must be in 1e-06...10"),
        ({"designs": {"a": scan()}, "noise": 10.1}, "noise 10.1: must be in 1e-06...10"),
        ({"designs": {"a": scan()}, "wavelength_nm": 532}, "a wavelength is that of a fit"),
        ({"designs": {"a": (1, 2)}}, "designs: expected .theta_i_deg, phi_i_deg"),
        ({"designs": {"a": 3}}, "designs: expected .theta_i_deg, phi_i_deg"),
        ({"designs": {"a": (0, 0, 90, 0)}}, "90"),
    ):
        with pytest.raises(ValueError, match=words):
            mmbrdf.plan(**arguments)


def test_has_a_picture():
    figure, axes = mmbrdf.plot.plan(mmbrdf.plan({"scan": scan()}, targets=["f:0:45"]))
    assert len(axes.lines) == 3 and [label.get_text() for label in axes.get_yticklabels()][-1] == "f_0_45"
    assert axes.get_xscale() == "log" and figure.axes == [axes]


def test_chooses_among_as_many_as_memory_holds():
    few, many = (mmbrdf.random_geometries(count, seed=1) for count in (10, 20001))
    with pytest.raises(ValueError, match="20001 candidates, more than 20000"):
        mmbrdf.choose(1, many)
    with pytest.raises(ValueError, match="1001 of the candidates are asked for, more than 1000"):
        mmbrdf.choose(1001, few)
    with pytest.raises(ValueError, match="candidates: expected"):
        mmbrdf.choose(1, few[:3])
