# SPDX-License-Identifier: BSD-3-Clause
"""Data sets and fits."""

import copy
import pickle

import numpy as np
import pytest

import mmbrdf


def largest_difference(first, second):
    """Over all coefficients of two models."""
    return max(np.abs(a.coefficients - b.coefficients).max() for a, b in zip(first.blocks, second.blocks, strict=True))


def test_a_dataset_holds_what_it_was_made_from(ptfe):
    geometry = mmbrdf.random_geometries(50, seed=2)
    for frame in ("xy", "sp", "scattering_plane"):
        f = ptfe.evaluate(532, *geometry, frame=frame)
        data = mmbrdf.Dataset(532, *geometry, f, frame=frame)
        assert len(data) == 50 and data.wavelengths_nm == (532,) and data.uncertainty is None
        np.testing.assert_allclose(data.mueller, ptfe.evaluate(532, *geometry), rtol=0, atol=2e-15)
        np.testing.assert_allclose(data.f11, f[:, 0, 0], rtol=1e-15)
        for there, here in zip(data.geometry, geometry):
            np.testing.assert_allclose(there, here, rtol=0, atol=1e-12)


def test_columns_of_a_dataset(samples):
    assert samples.normalized.shape == (1824, 4, 4) and (samples.normalized[:, 0, 0] == 1).all()
    np.testing.assert_array_equal(samples.mueller, samples.f11[:, None, None] * samples.normalized)
    with pytest.raises(ValueError, match="read-only"):
        samples.normalized[0, 0, 0] = 2
    assert samples.theta_i_deg.max() == pytest.approx(75)


def test_a_person_can_read_what_a_dataset_is(samples, ptfe):
    assert repr(samples) == "<mmbrdf.Dataset: 1824 samples at 532 nm>"
    assert repr(samples[:0]) == "<mmbrdf.Dataset: 0 samples>"
    two = mmbrdf.Dataset([633, 351], 0, 0, 30, 0, ptfe.evaluate(532, 0, 0, 30, 0), uncertainty=np.ones((4, 4)))
    assert repr(two) == "<mmbrdf.Dataset: 2 samples at 351, 633 nm, with uncertainties>"


def test_parts_of_a_dataset(samples):
    thirds = [samples[i::3] for i in range(3)]
    assert sum(map(len, thirds)) == len(samples)
    np.testing.assert_array_equal(thirds[1].f11, samples.f11[1::3])
    np.testing.assert_array_equal(samples[samples.theta_i_deg > 50].f11, samples.f11[samples.theta_i_deg > 50])
    np.testing.assert_array_equal(samples[[5, -1]].f11, samples.f11[[5, -1]])
    assert len(samples[7]) == 1 and len(samples[:0]) == 0
    with pytest.raises(IndexError):
        samples[5000]
    assert len(samples.at_wavelengths(532)) == len(samples)
    with pytest.raises(ValueError, match="532"):
        samples.at_wavelengths([633])


def test_copies_of_a_dataset_are_the_same(samples, tmp_path):
    samples.save(tmp_path / "data.csv")
    for same in (
        pickle.loads(pickle.dumps(samples)),
        copy.deepcopy(samples),
        mmbrdf.read_samples(tmp_path / "data.csv"),
    ):
        np.testing.assert_array_equal(same.mueller, samples.mueller)


def test_uncertainties_of_a_dataset_are_kept(ptfe, tmp_path):
    geometry = mmbrdf.random_geometries(20, seed=2)
    u = np.full((4, 4), 0.01)
    data = mmbrdf.Dataset(532, *geometry, ptfe.evaluate(532, *geometry), uncertainty=u)
    data.save(tmp_path / "data.csv")
    for one in (data, mmbrdf.load(tmp_path / "data.csv")):
        np.testing.assert_array_equal(one.uncertainty, np.broadcast_to(u, (20, 4, 4)))
    in_sp = mmbrdf.Dataset(532, *geometry, ptfe.evaluate(532, *geometry, frame="sp"), frame="sp", uncertainty=u)
    np.testing.assert_allclose(in_sp.mueller, data.mueller, atol=1e-15)
    np.testing.assert_allclose(
        in_sp.uncertainty[:, 0], 0.01, rtol=1e-12
    )  # equal ones stay equal: the turn is orthogonal


def test_states_s_and_p_out_of_plane_are_fitted_as_they_were_measured(ptfe, tmp_path):
    geometry = mmbrdf.random_geometries(600, seed=2)
    m = ptfe.evaluate(532, *geometry, frame="sp")
    m[:, 3, :] = m[:, :, 3] = np.nan
    m[10:, 2, :] = m[10:, :, 2] = np.nan  # ten samples of all linear states, else s and p
    data = mmbrdf.Dataset(532, *geometry, m, frame="sp")
    assert np.isnan(data.normalized[10:, 1, 1]).any()
    data.save(tmp_path / "s_and_p.csv")  # with the frame of each sample
    for one in (data, pickle.loads(pickle.dumps(data)), data[:], mmbrdf.load(tmp_path / "s_and_p.csv")):
        found = mmbrdf.fit(one, uncertainty="noise").model
        seen, truth = (model.evaluate(532, 40, 0, 50, 77)[:3, :3] for model in (found, ptfe))
        np.testing.assert_allclose(seen, truth, rtol=0, atol=1e-9)


def test_invalid_samples_are_refused(ptfe):
    f = ptfe.evaluate(532, 45, 0, 30, 180)
    with pytest.raises(ValueError, match=r"mueller: its shape \(3, 4\) does not end in \(4, 4\)"):
        mmbrdf.Dataset(532, 45, 0, 30, 180, f[:3])
    with pytest.raises(ValueError, match="polar angle"):
        mmbrdf.Dataset(532, 95, 0, 30, 180, f)
    with pytest.raises(ValueError):
        mmbrdf.Dataset(532, 45, 0, 30, 180, np.nan * f)
    with pytest.raises(ValueError, match="wavelength_nm"):
        mmbrdf.Dataset(-1, 45, 0, 30, 180, f)
    for frame in ("xy", "sp", "scattering_plane"):
        with pytest.raises(ValueError, match="u_m33 = -0.01, must be finite and not negative"):
            mmbrdf.Dataset(532, 45, 0, 30, 70, f, frame=frame, uncertainty=np.diag([0.01, 0.01, -0.01, 0.01]))
    with pytest.raises(ValueError, match="mueller: a part of it is masked"):
        mmbrdf.Dataset(532, 45, 0, 30, 180, np.ma.masked_array(f, mask=np.eye(4)))


def test_what_cannot_be_written_or_read_back_is_refused(samples, tmp_path):
    with pytest.raises(ValueError, match="without samples"):
        samples[:0].save(tmp_path / "empty.csv")
    with pytest.raises(FileNotFoundError, match="nowhere"):
        samples.save(tmp_path / "nowhere" / "data.csv")
    with pytest.raises(IsADirectoryError):
        samples.save(tmp_path)
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(ValueError, match="pickled"):
        pickle.loads(pickle.dumps(samples[:1]).replace(b"mmbrdf.Dataset 1", b"mmbrdf.Dataset 9"))


def test_the_program_fits_the_same_model(samples, program, tmp_path):
    samples.save(tmp_path / "data.csv")
    for options, arguments in (
        ({}, ()),
        ({"basis": "germer2017"}, ("--basis", "germer2017")),
        ({"weights": "estimated"}, ("--weights", "estimated")),
        ({"orders": (5, 3), "weights": "speckle", "covariance": "sandwich"},
         ("--orders", "5,3", "--weights", "speckle", "--covariance", "sandwich")),
    ):  # fmt: skip
        program("fit", "data.csv", "-o", "model.json", *arguments)
        there, here = (
            mmbrdf.load(tmp_path / "model.json"),
            mmbrdf.fit(mmbrdf.load(tmp_path / "data.csv"), **options).model,
        )
        assert largest_difference(there, here) <= 1e-12
        for a, b in zip(there.blocks, here.blocks, strict=True):
            assert (a.covariance is None) == (b.covariance is None) == (here.provenance["uncertainty"] == "sample")
            if a.covariance is not None:
                np.testing.assert_allclose(a.covariance, b.covariance, rtol=0, atol=1e-12)
            assert (a.rank, a.modes) == (b.rank, b.modes)
        for entry in ("rows", "weights", "noise", "covariance"):
            assert there.provenance.get(entry) == here.provenance.get(entry)


def test_a_fit_says_how_well_it_fits(samples):
    result = mmbrdf.fit(samples, uncertainty="noise", name="simulated", attribution="nobody")
    assert result.model.name == "simulated" and result.model.provenance["attribution"] == "nobody"
    np.testing.assert_array_equal(result.residuals, mmbrdf.residuals(result.model, samples))
    rms = np.sqrt((result.residuals**2).mean(axis=0))
    np.testing.assert_allclose(result.rms[1:], rms[1:], rtol=1e-9)
    assert result.polarization_rms == pytest.approx(np.sqrt((result.rms.ravel()[1:] ** 2).mean()))
    assert "1824 samples" in repr(result)


def test_chi_squared_per_degree_of_freedom_is_near_1_where_the_uncertainties_are_right(samples):
    u = 0.01 * np.sqrt(np.cos(np.radians(samples.theta_i_deg)) / np.cos(np.radians(samples.theta_r_deg)))
    u = u[:, None, None] * np.ones((4, 4))
    u[:, 0, 0] *= samples.f11
    known = mmbrdf.Dataset(532, *samples.geometry, samples.mueller, uncertainty=u)
    found = mmbrdf.fit(known, weights="data").chi_squared_per_dof
    assert list(found)[:3] == ["f11", "others", "11"] and found["11"] == pytest.approx(found["f11"], rel=1e-12)
    assert all(0.8 < value < 1.2 for value in found.values())


def test_uncertainties_count_as_given_or_scaled_by_the_residuals(samples):
    at = (532, 45, 0, 30, 180)

    def u_f11(times, **options):
        u = times * np.full((4, 4), 0.01)
        known = mmbrdf.Dataset(532, *samples.geometry, samples.mueller, uncertainty=u)
        return mmbrdf.fit(known, weights="data", **options).model.evaluate_uncertainty(*at)[0, 0]

    assert u_f11(3, covariance="given") == pytest.approx(3 * u_f11(1, covariance="given"), rel=1e-9)
    assert u_f11(3) == pytest.approx(u_f11(1), rel=1e-9)
    with pytest.raises(ValueError, match="takes weights data"):
        mmbrdf.fit(samples, covariance="given")


def test_a_fit_warns_of_what_contradicts_itself(samples):
    assert mmbrdf.fit(samples).warnings == []
    (percent,) = mmbrdf.fit(mmbrdf.Dataset(532, *samples.geometry, 100 * samples.mueller)).warnings
    assert "in percent?" in percent
    one_side = mmbrdf.fit(samples[np.sin(np.radians(samples.phi_r_deg - samples.phi_i_deg)) >= 0])
    assert pickle.loads(pickle.dumps(one_side)).warnings == one_side.warnings != []


def test_a_fit_warns_of_what_its_samples_show(samples):
    cosine = np.cos(np.radians(samples.theta_r_deg))[:, None, None]
    for data, words in [
        (mmbrdf.Dataset(532, *samples.geometry, cosine * samples.mueller), "cosine: "),
        (mmbrdf.Dataset(532, *samples.geometry, np.swapaxes(samples.mueller, 1, 2)), "transposed"),
        (mmbrdf.Dataset(532, *np.radians(samples.geometry), samples.mueller), "angles in radians"),
    ]:
        fitted = mmbrdf.fit(data)
        assert any(words in line for line in fitted.warnings), words
        assert pickle.loads(pickle.dumps(fitted)).warnings == fitted.warnings
        assert fitted.warnings[0] in fitted.summary()


def test_copies_of_a_fit_are_the_same(samples):
    for options in ({}, {"weights": "estimated", "orders": (3, 2)}):
        result = mmbrdf.fit(samples, **options)
        for same in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result)):
            assert repr(same) == repr(result) and same.model == result.model and same.noise == result.noise
            np.testing.assert_array_equal(same.residuals, result.residuals)
            np.testing.assert_array_equal(same.rms, result.rms)
            there, here = (mmbrdf.sample_diagnostics(one, samples) for one in (same, result))
            np.testing.assert_array_equal(there.studentized, here.studentized)
            np.testing.assert_array_equal(there.leverage[0].values, here.leverage[0].values)


def test_a_fit_as_printed_is_evaluated_as_it_was_fitted(ptfe, tmp_path):
    data = mmbrdf.simulate(ptfe, 532, mmbrdf.random_geometries(600, seed=5))
    result = mmbrdf.fit(data, "germer2017", (4, 2), as_printed=True, name="model")
    turned = mmbrdf.fit(data, "germer2017", (4, 2)).model
    model = result.model
    assert model.as_printed and not turned.as_printed
    assert repr(model).startswith("<mmbrdf.Model 'model': germer2017 as printed, orders (4, 2), ")
    f = model.evaluate(532, *data.geometry)
    np.testing.assert_allclose(data.f11 - f[:, 0, 0], result.residuals[:, 0, 0], rtol=0, atol=1e-15)
    np.testing.assert_allclose(mmbrdf.residuals(model, data), result.residuals, rtol=0, atol=0)
    assert mmbrdf.compare(model, data).normalized["22"].rms == pytest.approx(result.rms[1, 1], rel=1e-9)
    model.save(tmp_path / "model.json")
    for same in (mmbrdf.load(tmp_path / "model.json"), pickle.loads(pickle.dumps(model)), copy.deepcopy(model)):
        assert same.as_printed and same == model
        np.testing.assert_array_equal(same.evaluate(532, *data.geometry), f)
        u = same.evaluate_uncertainty(532, *data.geometry)
        np.testing.assert_array_equal(u, same.evaluate_uncertainty(532, *data.geometry, as_printed=True))
    # Asked as printed, a turned model is another function, as before; so is what coefficients alone are read as.
    assert (
        np.abs(turned.evaluate(532, *data.geometry, as_printed=True) - turned.evaluate(532, *data.geometry)).max()
        > 1e-4
    )
    model.save(tmp_path / "model.csv")
    coefficients = mmbrdf.load(tmp_path / "model.csv")
    assert not coefficients.as_printed
    np.testing.assert_allclose(coefficients.evaluate(532, *data.geometry, as_printed=True), f, rtol=0, atol=1e-12)


def test_a_fit_to_a_model_without_noise_is_that_model(ptfe):
    data = mmbrdf.simulate(ptfe, [351, 532, 633, 1064], mmbrdf.random_geometries(500, seed=1))
    result = mmbrdf.fit(data, reflectance=ptfe.reflectance, uncertainty="noise")
    assert largest_difference(result.model, ptfe) < 1e-12


def test_data_that_do_not_determine_a_model_are_refused(samples):
    with pytest.raises(ValueError, match="do not determine the model"):
        mmbrdf.fit(samples[:20])
    assert mmbrdf.fit(samples[:20], minimum_norm=True).model.blocks[0].rank < 40
    for wrong in ({"basis": "fourier"}, {"weights": "heavy"}, {"orders": (-1, 4)}, {"covariance": "small"}, {"powers": 3},
                  {"mapping": "flat"},
        {"as_printed": True}, {"weights": "data"}):  # fmt: skip
        with pytest.raises(ValueError):
            mmbrdf.fit(samples, **wrong)


def test_a_comparison_says_how_much_and_where(samples, ptfe):
    there = mmbrdf.compare(ptfe, samples)
    here = mmbrdf.residuals(ptfe, samples)
    assert there.samples == 1824
    assert there.f11.rms == pytest.approx(np.sqrt((here[:, 0, 0] ** 2).mean()), rel=1e-12)
    worst = np.abs(here[:, 1, 1]).argmax()
    assert there.normalized["22"].largest == pytest.approx(abs(here[worst, 1, 1]), rel=1e-12)
    assert there.normalized["22"].theta_r_deg == pytest.approx(samples.theta_r_deg[worst])


def test_estimated_noise_is_that_of_the_simulation(samples):
    (noise,) = mmbrdf.fit(samples, weights="estimated").noise
    assert noise["wavelength_nm"] == 532
    assert noise["scale"] == pytest.approx(0.01, rel=0.1)  # 3650 residuals: 5 standard deviations are 6 %


def test_the_published_fits_come_out(published):
    data = mmbrdf.load(published / "PTFE.data.csv")
    assert len(data) == 7296
    model = mmbrdf.fit(data.at_wavelengths(532), basis="germer2017").model
    file = mmbrdf.load(published / "PTFE.532.coeff.csv")
    assert largest_difference(model, file) < 1e-11


def test_a_fit_is_added_up_in_parts_that_were_sent_or_saved(samples, tmp_path):
    whole = mmbrdf.FitAccumulator("isotropic", (5, 3))
    whole.add(samples)
    first, second = (mmbrdf.FitAccumulator("isotropic", (5, 3)) for _ in range(2))
    first.add(samples[:700])
    second.add(samples[700:])
    first = pickle.loads(pickle.dumps(first))
    np.save(tmp_path / "second.npy", second.state())
    first.merge(mmbrdf.FitAccumulator.from_state(np.load(tmp_path / "second.npy"), "isotropic", (5, 3)))
    assert first.samples == len(samples)
    result, expected = first.solve(name="parts"), mmbrdf.fit(samples, orders=(5, 3), uncertainty="noise")
    assert largest_difference(result.model, expected.model) < 1e-12
    assert result.model.provenance["rows"] == "1824" and result.model.name == "parts"
    assert len(result.residuals) == 0
    np.testing.assert_allclose(result.rms, expected.rms, rtol=1e-10)
    with pytest.raises(ValueError, match="state of a fit"):
        mmbrdf.FitAccumulator.from_state(first.state()[:-1], "isotropic", (5, 3))
    with pytest.raises(ValueError, match="another basis"):
        mmbrdf.FitAccumulator.from_state(first.state(), "isotropic", (5, 3), mapping="projected")
    with pytest.raises(TypeError, match="state"):
        mmbrdf.FitAccumulator.from_state(first.state() + 1j, "isotropic", (5, 3))
    with pytest.raises(ValueError, match="different bases"):
        first.merge(mmbrdf.FitAccumulator())
