# SPDX-License-Identifier: BSD-3-Clause
"""Arguments that cannot be taken are refused in one line, which names them and says what is expected."""

import csv
import io
import re

import numpy as np
import pytest

import mmbrdf

MODEL = mmbrdf.material("ptfe-532")
HERE = (532, 45, 0, 30, 180)
DATA = mmbrdf.simulate(MODEL, 532, mmbrdf.random_geometries(30, seed=1))
STATES = mmbrdf.ideal_polarimeter(120, [-60, -20, 10, 50])
OTHER = mmbrdf.fit(mmbrdf.simulate(MODEL, 633, mmbrdf.random_geometries(400, seed=1)), orders=(2, 1)).model


def out_of(shape, dtype=float):
    return lambda: MODEL.evaluate(*HERE, out=np.zeros(shape, dtype))


def read_only():
    out = np.zeros((4, 4))
    out.flags.writeable = False
    MODEL.evaluate(*HERE, out=out)


def sharing():
    room = np.full((4, 4), 30.0)
    MODEL.evaluate(532, 45, 0, room[0, 0:1].reshape(()), 180, out=room)


@pytest.mark.parametrize(
    "call, message",
    [
        (out_of((4, 3)), "out: must be a writable array of float64 in C order, of the shape of the result"),
        (out_of((1, 4, 4)), "out: must be a writable array of float64 in C order, of the shape of the result"),
        (out_of((4, 4), np.float32), "out: must be a writable array of float64 in C order, of the shape of the result"),
        (read_only, "out: must be a writable array of float64 in C order, of the shape of the result"),
        (sharing, "out: shares memory with an argument"),
        (
            lambda: MODEL.evaluate(*HERE, uncertainty=True, terms={"tilt": 1}),
            "terms: tilt: expected scale, theta_i_deg, theta_r_deg, azimuth_deg or calibration",
        ),
        (lambda: MODEL.evaluate(532, [1, 2], 0, [1, 2, 3], 0), "shapes do not broadcast: "),
        (lambda: MODEL.evaluate(532, 45, np.inf, 30, 180), "direction phi_i_deg is not finite"),
        (lambda: MODEL.evaluate(532, 45, 0, 30, np.nan), "direction phi_r_deg is not finite"),
        (lambda: MODEL.evaluate(-532, 45, 0, 30, 180), "wavelength_nm = -532, must be positive and finite"),
        (lambda: MODEL.evaluate(0, 45, 0, 30, 180), "wavelength_nm = 0, must be positive and finite"),
        (lambda: MODEL.evaluate(np.inf, 45, 0, 30, 180), "wavelength_nm = inf, must be positive and finite"),
        (lambda: mmbrdf.compare(MODEL, DATA, geometry=(0, 0, 0, 0)), "geometry: goes with two models; samples have"),
        (lambda: mmbrdf.compare(MODEL, DATA, theta_max_deg=0.001), "theta_max_deg = 0.001: no geometry is within"),
        (
            lambda: mmbrdf.compare(MODEL, OTHER, geometry=(0, 0, 0, 0)),
            "wavelength_nm: needed, since there is none of which both models say that they were fitted to it",
        ),
        (
            lambda: mmbrdf.compare(MODEL, MODEL, geometry=(0, 0, 0)),
            "geometry: 3 arrays, expected theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg",
        ),
        (lambda: mmbrdf.fit(DATA, declared={"scale": -1}), "declared['scale'] must be 0 or more, not -1"),
        (lambda: mmbrdf.fit(DATA, declared={"scale": np.inf}), "declared['scale'] must be 0 or more, not inf"),
        (
            lambda: mmbrdf.fit(DATA, declared={"angle": 1}),
            "declared has no 'angle', only 'scale', 'source_deg' and 'receiver_deg'",
        ),
        (lambda: mmbrdf.Polarimeter(np.ones(4), np.eye(4)), "generator: expected an array (states, 4)"),
        (lambda: mmbrdf.Polarimeter(np.eye(4), np.ones((2, 4, 4))), "analyzer: expected an array (states, 4)"),
        (
            lambda: mmbrdf.Polarimeter(np.eye(4), np.eye(4), [[0, 0.5]]),
            "pairs: places of states are whole numbers from 0",
        ),
        (
            lambda: mmbrdf.Polarimeter(np.eye(4), np.eye(4), [[-1, 0]]),
            "pairs: places of states are whole numbers from 0",
        ),
        (lambda: mmbrdf.Polarimeter(np.eye(4), np.eye(4), [[0, 1e9]]), "pairs: places of states are whole numbers"),
        (lambda: mmbrdf.Polarimeter(np.eye(4), np.eye(4), [0, 1]), "pairs: expected an array (readings, 2)"),
        (lambda: mmbrdf.Polarimeter(np.eye(4), np.eye(4), np.zeros((0, 2))), "pairs: expected an array (readings, 2)"),
        (lambda: mmbrdf.rotating_retarders([1, 2]), "dials_deg: expected an array (readings, 2) of at most"),
        (lambda: mmbrdf.rotating_retarders(np.zeros((0, 2))), "dials_deg: expected an array (readings, 2) of at most"),
        (lambda: DATA[:0].save("nowhere.csv"), "a dataset without samples cannot be saved"),
    ],
)
def test_a_wrong_value_is_named_with_what_is_expected(call, message):
    with pytest.raises(ValueError, match="^" + re.escape(message)) as refusal:
        call()
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: MODEL.evaluate(532, None, 0, 30, 180), "theta_i_deg: None is not a number"),
        (lambda: MODEL.evaluate(532, "45", 0, 30, 180), "theta_i_deg: expected real numbers, not <U2"),
        (lambda: MODEL.evaluate(532, 45 + 1j, 0, 30, 180), "theta_i_deg: expected real numbers, not complex128"),
        (
            lambda: MODEL.evaluate(532, [[1], [1, 2]], 0, 30, 180),
            "theta_i_deg: expected a number or an array of numbers",
        ),
    ],
)
def test_a_wrong_type_is_named_with_what_is_expected(call, message):
    with pytest.raises(TypeError, match="^" + re.escape(message)):
        call()


@pytest.mark.parametrize(
    "theta", [[np.ma.masked, 1.0], np.ma.array([1.0, 2.0], mask=[1, 0]), [np.ma.array([1.0], mask=[1])]]
)
def test_masked_angles_are_not_taken_for_numbers(theta):
    with pytest.raises(ValueError, match="^theta_r_deg: a part of it is masked; leave it out$"):
        MODEL.evaluate(532, 45, 0, theta, 180)


@pytest.fixture(scope="module")
def raw(tmp_path_factory):
    """References and readings of a simulated instrument."""
    folder = tmp_path_factory.mktemp("raw")
    goniometer = mmbrdf.Goniometer(seed=1)
    goniometer.write_references(folder / "references.csv", 532)
    goniometer.write_raw(folder / "raw.csv", MODEL, 532, mmbrdf.random_geometries(2, seed=1))
    return goniometer, folder


def changed(path, to, **columns):
    """A copy of a file with another value in some columns."""
    rows = list(csv.DictReader(io.StringIO(path.read_text())))
    for row in rows:
        row.update(columns)
    with open(to, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    return to


def test_what_does_not_belong_to_readings_is_refused(raw, tmp_path):
    goniometer, folder = raw
    with pytest.raises(TypeError, match="^instrument: must be a Calibration or a Polarimeter, not None$"):
        mmbrdf.reduce(folder / "raw.csv", None, solid_angle=1e-4)
    film, references, readings = goniometer.film, folder / "references.csv", folder / "raw.csv"
    instrument = mmbrdf.calibrate(references, film=film)
    assert len(mmbrdf.reduce(readings, instrument, solid_angle=1e-4)) == 2
    other = changed(readings, tmp_path / "other.csv", wavelength_nm=633)
    frames = [[i, 5 * i] for i in range(16)]
    for call, message in (
        (
            lambda: mmbrdf.reduce(other, instrument, solid_angle=1e-4),
            f"{other}:17: another wavelength than that of the instrument",
        ),
        (
            lambda: mmbrdf.reduce(readings, instrument, solid_angle=1e-4, noise={"dark": -1}),
            "noise: dark: must be 0 or more",
        ),
        (
            lambda: mmbrdf.reduce(readings, instrument, solid_angle=1e-4, noise={"dark": np.nan}),
            "noise: dark: must be 0 or more",
        ),
        (
            lambda: mmbrdf.reduce(readings, instrument, solid_angle=1e-4, noise={"read": 1}),
            "noise: read: expected dark, shot or relative",
        ),
        (lambda: mmbrdf.reduce(readings, instrument, solid_angle=1e-4, saturation=0), "saturation: must be positive"),
        (lambda: mmbrdf.calibrate(references, film=film, saturation=-1), "saturation: must be positive"),
        (
            lambda: mmbrdf.calibrate(references, film=film, dials_deg=frames, refine=False),
            "dials_deg: refine=False and polarizer_near_deg are of instruments whose states stand still",
        ),
        (
            lambda: mmbrdf.calibrate(references, film=film, dials_deg=frames, polarizer_near_deg=0),
            "dials_deg: refine=False and polarizer_near_deg are of instruments whose states stand still",
        ),
        (
            lambda: mmbrdf.calibrate(references, film=film, dials_deg=frames),
            "references.csv: must have one reading of generator state j with analyzer state j for each of 16 rows of "
            "dials_deg",
        ),
    ):
        with pytest.raises(ValueError, match="^" + re.escape(message)):
            call()


def test_a_budget_has_degrees_of_freedom_of_its_own_parts_alone():
    with pytest.raises(ValueError, match="^degrees_of_freedom: there is no part drift$"):
        mmbrdf.budget({"scale": 0.1}, {"drift": 5})
