# SPDX-License-Identifier: BSD-3-Clause
"""From readings to a fitted model, as the program does it."""

import copy
import csv
import json
import os
import pickle
import subprocess
import warnings

import numpy as np
import pytest

import mmbrdf


@pytest.fixture(scope="module")
def chain(tmp_path_factory):
    """A simulated instrument that measured ptfe-532 at 300 geometries: (goniometer, folder, model)."""
    folder = tmp_path_factory.mktemp("raw")
    model = mmbrdf.material("ptfe-532")
    goniometer = mmbrdf.Goniometer(seed=1, speckle=0.01)
    goniometer.write_references(folder / "references.csv", 532)
    goniometer.write_raw(folder / "raw.csv", model, 532, mmbrdf.random_geometries(300, seed=1))
    return goniometer, folder, model


def test_optimal_states_have_the_smallest_condition_number():
    angles = mmbrdf.optimal_angles(131.81, 4)
    np.testing.assert_allclose(angles, [-51.69, -15.12, 15.12, 51.69], atol=0.01)
    ideal = mmbrdf.ideal_polarimeter(131.81, angles)
    assert mmbrdf.condition_number(ideal.generator) == pytest.approx(np.sqrt(3), abs=1e-4)


def test_readings_and_matrices_are_each_others_inverse(random_matrices):
    ideal = mmbrdf.ideal_polarimeter(120, [-60, -20, 10, 50, 80])
    readings = ideal.readings(random_matrices)
    assert readings.shape == (5, 7, 5, 5)
    np.testing.assert_allclose(readings, ideal.analyzer @ random_matrices @ ideal.generator.T, rtol=0, atol=1e-15)
    np.testing.assert_allclose(ideal.reduce(readings), random_matrices, rtol=0, atol=1e-14)
    assert ideal.covariance(np.ones((5, 5))).shape == (16, 16)
    uneven = mmbrdf.Polarimeter(ideal.generator, np.vstack([ideal.analyzer, ideal.analyzer[:1]]))
    np.testing.assert_allclose(
        uneven.readings(random_matrices), uneven.analyzer @ random_matrices @ uneven.generator.T, rtol=0, atol=1e-15
    )
    with pytest.raises(ValueError, match=r"readings: its shape \(4, 4\) does not end in \(5, 5\)"):
        ideal.reduce(np.ones((4, 4)))
    with pytest.raises(ValueError, match="generator"):
        mmbrdf.Polarimeter(np.ones(4), np.ones((4, 4)))


def test_reduction_keeps_single_precision_and_reads_any_strides(random_matrices):
    ideal = mmbrdf.ideal_polarimeter(120, [-60, -20, 10, 50, 80])
    readings = ideal.readings(random_matrices)
    exact = ideal.reduce(readings)
    assert exact.dtype == np.float64
    single = readings.astype(np.float32)
    found = ideal.reduce(single)
    assert found.dtype == np.float32
    assert (found == ideal.reduce(single.astype(np.float64)).astype(np.float32)).all()
    for given, expected in [(readings, exact), (single, found)]:
        frames_first = np.moveaxis(np.ascontiguousarray(np.moveaxis(given, (-2, -1), (0, 1))), (0, 1), (-2, -1))
        for same in (frames_first, np.asfortranarray(given), np.repeat(given, 2, axis=-1)[..., ::2]):
            assert (ideal.reduce(same) == expected).all() and not same.flags.c_contiguous
        assert (ideal.reduce(given[2, 3]) == expected[2, 3]).all()
        assert ideal.reduce(given[:0]).shape == (0, 7, 4, 4)
    many = np.broadcast_to(single[0, 0], (3, 7001, 5, 5))
    assert (ideal.reduce(many) == found[0, 0]).all()
    with pytest.raises(ValueError, match=r"readings: its shape \(4, 4\) does not end in \(5, 5\)"):
        ideal.reduce(np.ones((4, 4), np.float32))
    with pytest.raises(ValueError, match="masked"):
        ideal.reduce(np.ma.masked_greater(single, 0))


def test_readings_that_are_not_finite_are_refused_or_give_nan(random_matrices):
    ideal = mmbrdf.ideal_states(["s", "p", "+45", "-45", "L", "R"])
    for kind in (np.float32, np.float64):
        readings = ideal.readings(random_matrices).astype(kind)
        expected = ideal.reduce(readings)
        readings[1, 2, 3, 4] = np.inf
        with pytest.raises(ValueError, match=r"^a reading is not finite, at \[1, 2\]$"):
            ideal.reduce(readings)
        readings[4, 6] = np.nan
        with pytest.raises(ValueError, match=r"a reading is not finite, at \[1, 2\]; 2 pixels have no answer"):
            ideal.reduce(readings)
        found = ideal.reduce(readings, invalid="nan")
        assert np.isnan(found[1, 2]).all() and np.isnan(found[4, 6]).all()
        assert np.isnan(found).sum() == 32 and (np.isnan(found) | (found == expected)).all()
    with pytest.raises(ValueError, match="invalid = 'no', must be 'raise' or 'nan'"):
        ideal.reduce(readings, invalid="no")


def test_pairs_of_states_determine_what_they_determine_and_leave_nan(random_matrices):
    linear = mmbrdf.ideal_states(["s", "p", "+45", "-45"])
    assert linear.determined.tolist() == [[True] * 3 + [False]] * 3 + [[False] * 4]
    assert linear.rank == 9 and linear.pairs is None
    found = linear.reduce(linear.readings(random_matrices))
    assert np.isnan(found[..., 3, :]).all() and np.isnan(found[..., :, 3]).all()
    np.testing.assert_allclose(found[..., :3, :3], random_matrices[..., :3, :3], rtol=0, atol=1e-15)
    six = mmbrdf.ideal_states(["s", "p", "+45", "-45", "L", "R"])
    assert six.condition == pytest.approx(3) and six.determined.all()
    chosen = mmbrdf.Polarimeter(six.generator, six.analyzer, [(p, q) for p in range(6) for q in range(p, 6)])
    assert chosen.readings(random_matrices).shape == (5, 7, 21)
    np.testing.assert_allclose(
        chosen.reduce(chosen.readings(random_matrices)),
        np.where(chosen.determined, random_matrices, np.nan),
        atol=1e-14,
    )
    with pytest.raises(ValueError, match="state 'H': must be s, p"):
        mmbrdf.ideal_states(["s", "H"])
    with pytest.raises(ValueError, match="generator state 7, analyzer state 1"):
        mmbrdf.Polarimeter(six.generator, six.analyzer, [(6, 0)])
    with pytest.raises(ValueError, match="whole numbers"):
        mmbrdf.Polarimeter(six.generator, six.analyzer, [(0.5, 0)])


def test_two_turning_retarders_are_read_frame_by_frame(random_matrices):
    ideal = mmbrdf.rotating_retarders(mmbrdf.dial_angles(5, 6, 61))
    assert ideal.pairs.tolist() == [[j, j] for j in range(61)]
    assert ideal.rank == 16 and ideal.condition == pytest.approx(13.04, abs=5e-3)
    readings = ideal.readings(random_matrices)
    assert readings.shape == (5, 7, 61)
    np.testing.assert_allclose(ideal.reduce(readings), random_matrices, rtol=0, atol=1e-14)
    assert mmbrdf.rotating_retarders(mmbrdf.dial_angles(5, 10, 36)).rank == 14
    uneven = mmbrdf.rotating_retarders(
        [[0, 0], [10, 50]], retardance_deg=(85, 95), offset_deg=(1, -2), polarizer_deg=(0, 3), diattenuation=0.01
    )
    assert uneven.generator.shape == (2, 4)
    np.testing.assert_allclose(uneven.generator[0, 0], 1 + 0.01 * np.cos(np.radians(2)), rtol=1e-14)
    with pytest.raises(ValueError, match="retardance_deg: expected a number, or one for each arm"):
        mmbrdf.rotating_retarders([[0, 0]], retardance_deg=(90, 90, 90))


def test_two_turning_retarders_are_calibrated_from_air(tmp_path):
    dials = mmbrdf.dial_angles(5, 6, 61)
    goniometer = mmbrdf.Goniometer(seed=1, dials_deg=dials)
    goniometer.write_references(tmp_path / "references.csv", 532, count=3)
    goniometer.write_raw(tmp_path / "raw.csv", mmbrdf.material("ptfe-532"), 532, mmbrdf.random_geometries(20, seed=1))
    rows = (tmp_path / "references.csv").read_text().splitlines()
    (tmp_path / "air.csv").write_text("\n".join(rows[:1] + [row for row in rows if ",empty," in row]) + "\n")
    calibration = mmbrdf.calibrate(tmp_path / "air.csv", dials_deg=dials)
    values = calibration.retarders
    assert list(values)[:2] == ["generator_retardance_deg", "generator_offset_deg"]
    assert abs(values["generator_retardance_deg"][0] - 90) < 10
    assert 0 < values["generator_retardance_deg"][1] < 0.05
    assert values["generator_polarizer_deg"] == (0, None)
    calibration.save(tmp_path / "instrument.json")
    again = mmbrdf.load_instrument(tmp_path / "instrument.json")
    assert again.retarders == pytest.approx(values, rel=1e-12)
    data = mmbrdf.reduce(tmp_path / "raw.csv", again, solid_angle=goniometer.solid_angle)
    assert len(data) == 20
    assert data.reduction == "raw.csv by instrument.json, solid angle 0.0001114 sr, noise relative:0.001"
    data.save(tmp_path / "data.csv")
    kept = mmbrdf.read_samples(tmp_path / "data.csv")
    assert kept.reduction == kept[:5].reduction == data.reduction
    model = mmbrdf.fit(kept, orders=(1, 1), uncertainty="noise").model
    assert model.provenance["reduction"] == data.reduction
    truth = mmbrdf.material("ptfe-532").evaluate(
        532, data.theta_i_deg, data.phi_i_deg, data.theta_r_deg, data.phi_r_deg
    )
    np.testing.assert_allclose(data.normalized, mmbrdf.normalized(truth), atol=0.01)  # noise of 0.1 %, amplified
    exact = mmbrdf.reduce(tmp_path / "raw.csv", calibration.polarimeter, solid_angle=goniometer.solid_angle)
    np.testing.assert_allclose(exact.normalized, data.normalized, atol=1e-12)
    with pytest.raises(ValueError, match="turning retarders need dials_deg"):
        mmbrdf.calibrate(tmp_path / "air.csv")
    with pytest.raises(ValueError, match="each of 60 rows"):
        mmbrdf.calibrate(tmp_path / "air.csv", dials_deg=dials[:60])


def test_elements_are_those_of_the_textbook():
    np.testing.assert_allclose(
        mmbrdf.polarizer(0), 0.5 * np.array([[1, 1, 0, 0], [1, 1, 0, 0], [0] * 4, [0] * 4]), atol=1e-16
    )
    np.testing.assert_allclose(mmbrdf.retarder(180, [0, 90])[0], np.diag([1, 1, -1, -1]), atol=1e-15)
    film = mmbrdf.film_reflection((1.4607, 1.0, 4.15 + 0.044j), 532, [30, 75])
    assert film.shape == (2, 4, 4) and mmbrdf.realizable(film).all()


def test_the_program_calibrates_and_reduces_to_the_same_numbers(chain, program, tmp_path):
    goniometer, folder, _ = chain
    instrument = mmbrdf.calibrate(folder / "references.csv", film=goniometer.film)
    data = mmbrdf.reduce(folder / "raw.csv", instrument, solid_angle=goniometer.solid_angle)
    program("calibrate", folder / "references.csv", "--film", "1.4607,1.0,4.15,0.044", "-o", "instrument.json")
    program(
        "reduce",
        folder / "raw.csv",
        "--instrument",
        "instrument.json",
        "--solid-angle",
        goniometer.solid_angle,
        "-o",
        "data.csv",
    )
    there = mmbrdf.load(tmp_path / "data.csv")
    np.testing.assert_array_equal(there.mueller, data.mueller)
    np.testing.assert_array_equal(there.uncertainty, data.uncertainty)
    instrument.save(folder / "instrument.json")
    for again in (
        mmbrdf.load_instrument(folder / "instrument.json"),
        mmbrdf.load_instrument(tmp_path / "instrument.json"),
    ):
        np.testing.assert_array_equal(again.polarimeter.generator, instrument.polarimeter.generator)
        np.testing.assert_array_equal(again.covariance, instrument.covariance)


def test_copies_of_an_instrument_are_the_same(chain):
    goniometer, folder, _ = chain
    instrument = mmbrdf.calibrate(folder / "references.csv", film=goniometer.film)
    for same in (pickle.loads(pickle.dumps(instrument)), copy.deepcopy(instrument)):
        assert repr(same) == repr(instrument) and same.provenance == instrument.provenance
        np.testing.assert_array_equal(same.covariance, instrument.covariance)
        np.testing.assert_array_equal(same.polarimeter.analyzer, instrument.polarimeter.analyzer)
        data = mmbrdf.reduce(folder / "raw.csv", same, solid_angle=goniometer.solid_angle)
        assert mmbrdf.fit(data, orders=(3, 2), instrument=same).model.provenance["instrument"] == "references.csv"


def test_the_calibrated_instrument_is_the_true_one_within_its_uncertainty(chain):
    goniometer, folder, _ = chain
    instrument = mmbrdf.calibrate(folder / "references.csv", film=goniometer.film)
    truth, found = goniometer.polarimeter, instrument.polarimeter
    errors = np.concatenate(
        [(found.generator / found.generator[:, :1].mean() - truth.generator / truth.generator[:, :1].mean()).ravel()]
    )
    u = np.sqrt(np.diag(instrument.covariance))[: errors.size]
    assert np.sqrt((errors**2).mean() / (u**2).mean()) < 2  # 16 errors: a ratio of 2 has a probability below 1e-5
    assert instrument.figure_of_merit == pytest.approx(7.5e-4, rel=0.15)


def test_readings_become_a_model_within_its_uncertainty(chain):
    goniometer, folder, truth = chain
    instrument = mmbrdf.calibrate(folder / "references.csv", film=goniometer.film)
    data = mmbrdf.reduce(folder / "raw.csv", instrument, solid_angle=goniometer.solid_angle, noise={"relative": 0.01})
    alone = mmbrdf.fit(data, weights="data").model
    model = mmbrdf.fit(data, weights="data", instrument=instrument).model
    question = (532, 45, 0, [10, 30, 50], 180)
    u = model.evaluate_uncertainty(*question)[:, 0, 0]
    assert (u > alone.evaluate_uncertainty(*question)[:, 0, 0]).all()
    error = model.evaluate(*question)[:, 0, 0] - truth.evaluate(*question)[:, 0, 0]
    assert (np.abs(error) < 5 * u).all()


def test_a_model_says_that_its_instrument_is_in_its_uncertainty(chain, program, tmp_path):
    goniometer, folder, _ = chain
    found = mmbrdf.calibrate(folder / "references.csv", film=goniometer.film)
    found.save(tmp_path / "instrument.json")
    loaded = mmbrdf.load_instrument(tmp_path / "instrument.json")
    data = mmbrdf.reduce(folder / "raw.csv", loaded, solid_angle=goniometer.solid_angle)
    data.save(tmp_path / "data.csv")
    program("fit", "data.csv", "--orders", "3,2", "--instrument", "instrument.json", "-o", "there.json")
    there = mmbrdf.load(tmp_path / "there.json")
    here = mmbrdf.fit(mmbrdf.load(tmp_path / "data.csv"), orders=(3, 2), instrument=loaded).model
    assert here.provenance["instrument"] == there.provenance["instrument"] == "instrument.json"
    where = (532, 45, 0, 30, 180)
    np.testing.assert_allclose(there.evaluate_uncertainty(*where), here.evaluate_uncertainty(*where), rtol=1e-9)
    here.save(tmp_path / "here.json")
    told = program("analyze", "here.json", "-i", "45,0", "-r", "30,180")
    assert "standard (k = 1), of the sample and its instrument: --term adds the rest of a budget" in told
    alone = mmbrdf.fit(data, orders=(3, 2)).model
    assert "instrument" not in alone.provenance
    from_references = mmbrdf.fit(data, orders=(3, 2), instrument=found).model
    assert from_references.provenance["instrument"] == "references.csv"


def test_the_page_about_a_model_says_what_its_uncertainty_is_of(chain, tmp_path):
    pytest.importorskip("matplotlib")
    goniometer, folder, _ = chain
    instrument = mmbrdf.calibrate(folder / "references.csv", film=goniometer.film)
    data = mmbrdf.reduce(folder / "raw.csv", instrument, solid_angle=goniometer.solid_angle)
    for options, words in (({}, "of the sample"), ({"instrument": instrument}, "of the sample and its instrument")):
        mmbrdf.report(mmbrdf.fit(data, orders=(3, 2), **options).model, None, tmp_path / "page.html")
        page = (tmp_path / "page.html").read_text().replace("\u00a0", " ")
        assert f"Uncertainties are standard (k = 1), {words}; " in page


def saved_with(instrument, path, merit=None, divisor=None):
    """A file of the instrument with another figure of merit, or with S4 of the generator over a divisor."""
    instrument.save(path)
    fields = json.loads(path.read_text())
    if merit:
        fields["figure_of_merit"]["total"] = merit
    if divisor:
        fields["generator"] = [[*state[:3], state[3] / divisor] for state in fields["generator"]]
        fields["generator_condition"] = mmbrdf.condition_number(fields["generator"])
    path.write_text(json.dumps(fields))
    return path


def test_an_instrument_that_the_program_refuses_or_doubts_is_refused_or_doubted(chain, tmp_path):
    goniometer, folder, _ = chain
    path = tmp_path / "bad.json"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        good = mmbrdf.calibrate(folder / "references.csv", film=goniometer.film)
        mmbrdf.load_instrument(saved_with(good, path))
    with pytest.raises(
        ValueError, match=r"^bad.json: figure of merit 0.6, more than 0.5: are states or references mixed"
    ):
        mmbrdf.load_instrument(saved_with(good, path, merit=0.6))
    with pytest.warns(mmbrdf.InstrumentWarning, match=r"^bad.json: figure of merit 0.051, more than 0.05: are states"):
        mmbrdf.load_instrument(saved_with(good, path, merit=0.051))
    with pytest.raises(
        ValueError, match=r"^bad.json: the condition number of the generator is 1\d\d.\d, more than 100$"
    ):
        mmbrdf.load_instrument(saved_with(good, path, divisor=100))
    with pytest.warns(
        mmbrdf.InstrumentWarning, match="the condition number of the generator is .*, more than 10: noise"
    ):
        mmbrdf.load_instrument(saved_with(good, path, divisor=10))
    index, _, substrate = goniometer.film
    with pytest.warns(
        mmbrdf.InstrumentWarning, match=r"^references.csv: the film is .* um thick, \+15 % from the given"
    ):
        mmbrdf.calibrate(folder / "references.csv", film=(index, 0.87, substrate))


def test_references_that_do_not_belong_to_an_instrument_are_doubted(chain, tmp_path):
    goniometer, folder, _ = chain
    rows = list(csv.DictReader((folder / "references.csv").read_text().splitlines()))
    for row in rows:
        if row["reference"] == "polarizer" and float(row["angle_deg"]) > 90:
            row["angle_deg"] = float(row["angle_deg"]) - 10
    with open(tmp_path / "bad.csv", "w", newline="") as file:
        table = csv.DictWriter(file, rows[0])
        table.writeheader()
        table.writerows(rows)
    with pytest.warns(mmbrdf.InstrumentWarning, match=r"^bad.csv: figure of merit 0.05\d, more than 0.05: are states"):
        mmbrdf.calibrate(tmp_path / "bad.csv", film=goniometer.film)


def test_matrices_that_cannot_be_physical_are_doubted(chain, tmp_path):
    goniometer, folder, _ = chain
    instrument = mmbrdf.calibrate(folder / "references.csv", film=goniometer.film)
    header, *lines = (folder / "raw.csv").read_text().splitlines()
    rows = [line.split(",") for line in lines]
    for fields in rows:
        if int(fields[5]) < 4 and fields[6] == "1":
            fields[8] = str(30 * float(fields[8]))
    (tmp_path / "bad.csv").write_text("\n".join([header, *map(",".join, rows)]))
    with pytest.warns(mmbrdf.InstrumentWarning, match=r"^bad.csv: 3 of 300 matrices cannot be physical: are generator"):
        data = mmbrdf.reduce(tmp_path / "bad.csv", instrument, solid_angle=goniometer.solid_angle)
    assert len(data) == 300
    with warnings.catch_warnings():
        warnings.simplefilter("error", mmbrdf.InstrumentWarning)
        with pytest.raises(mmbrdf.InstrumentWarning):
            mmbrdf.reduce(tmp_path / "bad.csv", instrument, solid_angle=goniometer.solid_angle)


def test_what_cannot_be_calibrated_or_reduced_is_refused(chain, tmp_path):
    goniometer, folder, _ = chain
    with pytest.raises(FileNotFoundError):
        mmbrdf.calibrate(tmp_path / "nowhere.csv")
    with pytest.raises(ValueError, match="wafer"):
        mmbrdf.calibrate(folder / "references.csv")
    with pytest.raises(ValueError, match="noise: shots"):
        mmbrdf.calibrate(folder / "references.csv", film=goniometer.film, noise={"shots": 1})
    linear = mmbrdf.calibrate(folder / "references.csv", film=goniometer.film, refine=False)
    assert linear.covariance is None
    data = mmbrdf.reduce(folder / "raw.csv", linear, solid_angle=goniometer.solid_angle)
    with pytest.raises(ValueError, match="references.csv: a linear calibration, without a covariance"):
        mmbrdf.fit(data, instrument=linear)
    instrument = mmbrdf.calibrate(folder / "references.csv", film=goniometer.film)
    elsewhere = mmbrdf.simulate(mmbrdf.material("ptfe-633"), 633, mmbrdf.random_geometries(300, seed=1))
    with pytest.raises(ValueError, match="references.csv: of 532 nm, but there are data at 633 nm"):
        mmbrdf.fit(elsewhere, orders=(3, 2), instrument=instrument)
    with pytest.raises(ValueError, match="solid"):
        mmbrdf.reduce(folder / "raw.csv", linear, solid_angle=-1)


def test_a_fit_as_printed_has_the_uncertainty_of_its_instrument(chain):
    """Refitted with each error of the instrument in the data, coefficients move as the covariance added says."""
    goniometer, folder, model = chain
    instrument = mmbrdf.calibrate(folder / "references.csv", film=goniometer.film)
    polarimeter, geometry = instrument.polarimeter, mmbrdf.random_geometries(200, seed=2)
    true = model.evaluate(532, *geometry, frame="scattering_plane")

    def fitted(matrices, **options):
        data = mmbrdf.Dataset(532, *geometry, matrices, frame="scattering_plane")
        return mmbrdf.fit(data, "germer2017", (3, 2), **options).model

    def added(**options):
        before, after = fitted(true, **options), fitted(true, instrument=instrument, **options)
        assert after.provenance["instrument"] == "references.csv" and after.as_printed == before.as_printed
        return [b.covariance - a.covariance for a, b in zip(before.blocks, after.blocks, strict=True)]

    here, part = added(as_printed=True), 1e-3
    expected = [np.zeros_like(one) for one in here]
    coefficients = [block.coefficients.ravel() for block in fitted(true, as_printed=True).blocks]
    variances, errors = np.linalg.eigh(instrument.covariance)
    for variance, error in zip(variances, errors.T, strict=True):
        generator, analyzer = (part * np.sqrt(max(variance, 0)) * error).reshape(2, -1, 4)
        other = mmbrdf.Polarimeter(polarimeter.generator + generator, polarimeter.analyzer + analyzer)
        moved = fitted(other.reduce(polarimeter.readings(true)), as_printed=True)
        for total, before, after in zip(expected, coefficients, moved.blocks, strict=True):
            change = (after.coefficients.ravel() - before) / part
            total += np.outer(change, change)
    for one, there in zip(here, expected, strict=True):
        np.testing.assert_allclose(one, there, rtol=0, atol=5e-3 * there.max())
    turned = zip(added(), expected, strict=True)  # has other rows
    assert any(np.abs(one - there).max() > 0.1 * there.max() for one, there in turned)


def test_a_fit_without_degrees_of_freedom_has_no_place_for_an_instrument(chain, tmp_path):
    goniometer, folder, _ = chain
    instrument = mmbrdf.calibrate(folder / "references.csv", film=goniometer.film)
    instrument.save(tmp_path / "instrument.json")
    data = mmbrdf.reduce(folder / "raw.csv", instrument, solid_angle=goniometer.solid_angle)[:2]
    data.save(tmp_path / "data.csv")
    with pytest.raises(ValueError) as refused:
        mmbrdf.fit(data, orders=(1, 0), instrument=instrument)
    assert "block 11 has no covariance to which that of the instrument could be added: 2 rows" in str(refused.value)
    command = [os.environ["MMBRDF_PROGRAM"], "fit", "data.csv", "--orders", "1,0", "--instrument", "instrument.json"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (1, f"mmbrdf: data.csv: {refused.value}\n")


def test_a_quarter_wave_retarder_at_45_degrees_makes_linear_light_circular():
    light = mmbrdf.retarder(90, 45) @ [1, 1, 0, 0]
    np.testing.assert_allclose(np.abs(light), [1, 0, 0, 1], rtol=0, atol=1e-15)
