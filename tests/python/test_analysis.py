# SPDX-License-Identifier: BSD-3-Clause
"""Frames, conventions, analysis and radiometry over arrays."""

import copy
import pickle
import warnings

import numpy as np
import pytest

import mmbrdf

QUANTITIES = ("depolarization", "diattenuation", "polarizance", "purity", "entropy", "realizability_margin")


@pytest.mark.parametrize("name", [*QUANTITIES, "realizable", "coherency_eigenvalues", "coherency", "diattenuation_vector",
                                  "polarizance_vector", "normalized", "exchanged", "mirrored", "nearest_realizable"])  # fmt: skip
def test_quantities_are_taken_matrix_by_matrix(name, random_matrices):
    quantity = getattr(mmbrdf, name)
    whole = np.asarray(quantity(random_matrices))
    for i, j in np.ndindex(5, 7):
        np.testing.assert_array_equal(whole[i, j], quantity(random_matrices[i, j]))
    np.testing.assert_array_equal(np.asarray(quantity(random_matrices[::2, ::-1])), whole[::2, ::-1])
    assert quantity(np.empty((0, 4, 4))).shape[0] == 0


def test_a_single_matrix_gives_a_number(random_matrices):
    assert isinstance(mmbrdf.depolarization(random_matrices[0, 0]), float)
    assert mmbrdf.depolarization(np.diag([1, 0, 0, 0])) == 0
    assert mmbrdf.realizable(np.eye(4)) and not mmbrdf.realizable(np.diag([1, 1, 1, -1]))


def test_depolarization_is_that_of_eq_21(random_matrices):
    m = random_matrices
    expected = np.sqrt((m**2).sum(axis=(-1, -2)) - m[..., 0, 0] ** 2) / (np.sqrt(3) * m[..., 0, 0])
    np.testing.assert_allclose(mmbrdf.depolarization(m), expected, rtol=1e-14)


@pytest.mark.parametrize("name", QUANTITIES)
def test_gradients_are_the_slopes_of_the_quantities(name, random_matrices):
    quantity, gradient = getattr(mmbrdf, name), getattr(mmbrdf, name + "_gradient")(random_matrices)
    step = 1e-6 * np.random.default_rng(2).normal(size=(4, 4))
    difference = (quantity(random_matrices + step) - quantity(random_matrices - step)) / 2
    np.testing.assert_allclose((gradient * step).sum(axis=(-1, -2)), difference, rtol=1e-4, atol=1e-12)


def test_uncertainties_of_quantities_follow_from_the_covariance(ptfe):
    question = (532, 45, 0, np.linspace(0, 60, 4), 180)
    f, v = ptfe.evaluate(*question), ptfe.covariance(*question)
    g = mmbrdf.depolarization_gradient(f)
    expected = np.sqrt(np.einsum("ni,nij,nj->n", g.reshape(4, 16), v, g.reshape(4, 16)))
    np.testing.assert_allclose(mmbrdf.standard_uncertainty(g, v), expected, rtol=1e-12)


def test_a_retarder_has_its_retardance():
    np.testing.assert_allclose(mmbrdf.retardance(mmbrdf.retarder([0, 30, 90, 180], 20)), [0, 30, 90, 180], atol=1e-5)


def test_decompositions_multiply_back(random_matrices):
    parts = mmbrdf.lu_chipman(random_matrices)
    product = parts.depolarizer @ parts.retarder @ parts.diattenuator
    np.testing.assert_allclose(product, random_matrices, rtol=0, atol=1e-12 * random_matrices.max())
    s = mmbrdf.symmetric_decomposition(random_matrices)
    product = s.diattenuator2 @ s.retarder2 @ s.depolarizer @ np.swapaxes(s.retarder1, -1, -2) @ s.diattenuator1
    np.testing.assert_allclose(product, random_matrices, rtol=0, atol=1e-8 * random_matrices.max())
    c = mmbrdf.cloude_decomposition(random_matrices)
    assert c.weights.shape == (5, 7, 4) and c.components.shape == (5, 7, 4, 4, 4)
    np.testing.assert_allclose(
        np.einsum("...q,...qij->...ij", c.weights, c.components), random_matrices, rtol=0, atol=1e-13
    )


def test_co_and_cross_polarized_parts_are_what_polarizers_leave(ptfe):
    m = ptfe.evaluate(532, 45, 0, np.linspace(-60, 60, 5), 180, frame="sp")
    parts = mmbrdf.co_and_cross_polarized(m)
    for name, a, b in (("ss", 1, 1), ("sp", 1, -1), ("ps", -1, 1), ("pp", -1, -1)):
        expected = (m[:, 0, 0] + a * m[:, 0, 1] + b * m[:, 1, 0] + a * b * m[:, 1, 1]) / 2
        np.testing.assert_allclose(getattr(parts, name), expected, rtol=1e-15)
        gradient = getattr(mmbrdf.co_and_cross_polarized_gradients(), name)
        np.testing.assert_allclose((gradient * m).sum(axis=(-1, -2)), expected, rtol=1e-14)
    geometry = mmbrdf.in_plane(45, np.linspace(-60, 60, 5))
    np.testing.assert_allclose(mmbrdf.polarized_curve(ptfe, 532, geometry).ss,
                               mmbrdf.co_and_cross_polarized(ptfe.evaluate(532, *geometry, frame="sp")).ss)  # fmt: skip


def test_frames_change_back_and_forth(ptfe):
    geometry = mmbrdf.random_geometries(30, seed=4)
    f = {frame: ptfe.evaluate(532, *geometry, frame=frame) for frame in ("xy", "sp", "scattering_plane")}
    for before in f:
        for after in f:
            changed = mmbrdf.change_frame(f[before], *geometry, from_frame=before, to_frame=after)
            np.testing.assert_allclose(changed, f[after], rtol=0, atol=1e-14)


def test_the_place_of_an_angle_that_is_refused_is_said_once():
    with pytest.raises(ValueError) as error:
        mmbrdf.change_frame(np.eye(4), [[30], [95]], 0, [20, 30], 0, "xy", "sp")
    assert str(error.value) == "direction 95,0: the polar angle is not in [-90, 90] degrees, at [1, 0]"


def test_conventions_and_rotators():
    np.testing.assert_allclose(mmbrdf.rotator(45) @ [1, 1, 0, 0], [1, 0, -1, 0], atol=1e-15)
    assert mmbrdf.rotator([0, 30, 60]).shape == (3, 4, 4)
    m = np.arange(16.0).reshape(4, 4)
    converted = mmbrdf.convert(m, "germer2017", "s_first_right")
    np.testing.assert_array_equal(converted[:3, :3], m[:3, :3])
    np.testing.assert_array_equal(converted[3, :3], -m[3, :3])
    with pytest.raises(ValueError, match="p_first_left"):
        mmbrdf.convert(m, "germer2017", "other")


def test_impossible_matrices_are_refused():
    for function in (mmbrdf.depolarization, mmbrdf.lu_chipman, mmbrdf.purity):
        with pytest.raises(ValueError):
            function(-np.eye(4))
        with pytest.raises(ValueError, match="does not end in"):
            function(np.eye(3))


def test_reflectances_and_their_uncertainties(ptfe):
    dhr = mmbrdf.directional_hemispherical_reflectance(ptfe, [351, 532], theta_i_deg=[[0], [45], [75]])
    assert dhr.shape == (3, 2) and ((dhr > 0.9) & (dhr < 1.02)).all()
    polarized = mmbrdf.directional_hemispherical_reflectance(ptfe, 532, 60, stokes=[[1, 1, 0, 0], [1, -1, 0, 0]])
    unpolarized = mmbrdf.directional_hemispherical_reflectance(ptfe, 532, 60)
    assert polarized.mean() == pytest.approx(unpolarized, rel=1e-13)
    assert mmbrdf.hemispherical_directional_reflectance(ptfe, 532, 60) == pytest.approx(unpolarized, rel=1e-13)
    with warnings.catch_warnings():  # theta_i is fitted up to 75 degrees, theta_r to 81.9
        warnings.simplefilter("error", mmbrdf.ExtrapolationWarning)
        mmbrdf.hemispherical_directional_reflectance(ptfe, 532, 80)
    with pytest.warns(mmbrdf.ExtrapolationWarning):
        mmbrdf.directional_hemispherical_reflectance(ptfe, 532, 80)
    u = mmbrdf.directional_hemispherical_uncertainty(ptfe, 532, 60)
    assert 1e-5 < u < 1e-2 and mmbrdf.hemispherical_directional_uncertainty(ptfe, 532, 60) == pytest.approx(u, rel=1e-9)
    assert 0.95 < mmbrdf.bihemispherical_reflectance(ptfe, 532) < 1
    assert mmbrdf.bihemispherical_uncertainty(ptfe, [532, 633]).shape == (2,)
    assert mmbrdf.reflectance_factor(1 / np.pi) == pytest.approx(1)


def test_a_certified_model_has_the_certified_reflectance_and_its_uncertainty():
    nm, value, u = [443, 532], [0.99, 0.988], 0.004
    model = mmbrdf.certified(mmbrdf.material("ptfe"), nm, value, u)
    np.testing.assert_allclose(mmbrdf.directional_hemispherical_reflectance(model, nm, 8), value, rtol=1e-12)
    np.testing.assert_allclose(mmbrdf.directional_hemispherical_uncertainty(model, nm, 8), u, rtol=1e-8)
    np.testing.assert_array_equal(model.wavelengths_nm, nm)
    copy = pickle.loads(pickle.dumps(model))
    assert copy == model
    with pytest.warns(UserWarning, match="changes f11 by up to 49"):
        mmbrdf.certified(mmbrdf.material("ptfe"), 532, 0.5, 0.01)
    with pytest.raises(ValueError, match="98.8 .* a part of 1"):
        mmbrdf.certified(mmbrdf.material("ptfe"), 532, 98.8, 0.4)


def test_what_is_no_covariance_is_refused():
    ones = np.ones((4, 4))
    assert mmbrdf.standard_uncertainty(ones, np.eye(16)) == pytest.approx(4)
    assert mmbrdf.standard_uncertainty(ones, np.zeros((16, 16))) == 0
    indefinite, lopsided = np.eye(16), np.eye(16)
    indefinite[0, 1] = indefinite[1, 0] = 2
    lopsided[2, 3] = 0.5
    for wrong, message in (
        (-np.eye(16), "not positive semidefinite"),
        (indefinite, "not positive semidefinite"),
        (lopsided, "not symmetric: 0.5 and 0 at 2, 3"),
        (np.full((16, 16), np.nan), "not finite"),
    ):
        with pytest.raises(ValueError, match=message):
            mmbrdf.standard_uncertainty(ones, wrong)
    with pytest.raises(ValueError, match=r"semidefinite.*at \[1\]"):
        mmbrdf.standard_uncertainty(ones, np.stack([np.eye(16), -np.eye(16)]))


# The parts of what a fit of the sample leaves uncertain, as the built-in materials were fitted.
OF_THE_SAMPLE = ["posterior", "declared scale", "declared source arm", "declared receiver arm", "projection"]


def together(parts):
    return np.sqrt(sum(part**2 for part in parts.values()))


def test_a_term_is_one_error_for_all_directions(ptfe):
    scale = {"scale": 0.003}
    for name, value in (("directional_hemispherical", (532, 60)), ("hemispherical_directional", (532, 60)), ("bihemispherical", (532,))):  # fmt: skip
        reflectance, u = getattr(mmbrdf, name + "_reflectance"), getattr(mmbrdf, name + "_uncertainty")
        parts = u(ptfe, *value, terms=scale, by_term=True)
        assert list(parts) == [*OF_THE_SAMPLE, "scale"]
        assert parts["scale"] == pytest.approx(0.003 * reflectance(ptfe, *value), rel=1e-9)
        assert together(parts) == pytest.approx(u(ptfe, *value, terms=scale), rel=1e-12)
        assert together(u(ptfe, *value, by_term=True)) == pytest.approx(u(ptfe, *value), rel=1e-12)
    source, receiver = mmbrdf.Aperture.cone(8, 0, 1), mmbrdf.Aperture.ring(40, 50)
    mean = mmbrdf.average(ptfe, 532, source, receiver)[0]
    alone = mmbrdf.average_uncertainty(ptfe, 532, source, receiver)
    both = mmbrdf.average_uncertainty(ptfe, 532, source, receiver, terms=scale)
    assert alone.shape == (4, 4)
    assert both[0, 0] == pytest.approx(np.hypot(alone[0, 0], 0.003 * mean[0, 0]), rel=1e-6)
    with pytest.raises(ValueError, match="terms: phi"):
        mmbrdf.bihemispherical_uncertainty(ptfe, 532, terms={"phi": 1})
    with pytest.raises(ValueError, match=r"^terms: 'phi\\x0a': expected scale, [^\n]*$"):
        mmbrdf.bihemispherical_uncertainty(ptfe, 532, terms={"phi\n": 1})


def test_a_budget_can_be_signed(ptfe):
    signed = mmbrdf.budget({"fit": [3.0, 0.0], "scale": 4.0}, {"fit": 10})
    np.testing.assert_allclose(signed.u, [5, 4])
    np.testing.assert_allclose(signed.degrees_of_freedom, [5**4 / (3**4 / 10), np.inf])
    np.testing.assert_allclose(signed.U, signed.k * signed.u)
    assert signed.k[1] == 2 and 1.96 < signed.k[0] < 2.0
    assert mmbrdf.budget({"fit": 1.0}, {"fit": 1}).k == pytest.approx(12.706, abs=1e-3)
    assert ptfe.degrees_of_freedom > 1
    with pytest.raises(ValueError, match="there is no part scale"):
        mmbrdf.budget({"fit": 1.0}, {"scale": 3})


def test_means_over_apertures(ptfe):
    source, receiver = mmbrdf.Aperture.direction(8, 0), mmbrdf.Aperture.hemisphere()
    with pytest.warns(mmbrdf.ExtrapolationWarning, match="theta_r"):
        mean, error, converged = mmbrdf.average(ptfe, 532, source, receiver)
    assert converged and error < 1e-9
    dhr = mmbrdf.directional_hemispherical_reflectance(ptfe, 532, 8)
    assert np.pi * mean[0, 0] == pytest.approx(dhr, rel=1e-10)
    assert mmbrdf.Aperture.cone(30, 0, 5).projected_solid_angle == pytest.approx(
        np.pi * np.cos(np.radians(30)) * np.sin(np.radians(5)) ** 2
    )
    port = receiver.without(mmbrdf.Aperture.cone(8, 180, 4))
    assert port.projected_solid_angle < receiver.projected_solid_angle
    with pytest.raises(ValueError):
        mmbrdf.Aperture.cone(89, 0, 5)


def test_copies_of_an_aperture_are_the_same():
    shapes = [
        mmbrdf.Aperture.direction(8, 30),
        mmbrdf.Aperture.annulus(20, 10, 1, 3),
        mmbrdf.Aperture.ellipse(45, 180, 2, 1, turn_deg=30),
        mmbrdf.Aperture.rectangle(45, 180, 2, 1),
        mmbrdf.Aperture.ring(44, 46),
        mmbrdf.Aperture.hemisphere().without(mmbrdf.Aperture.cone(8, 180, 4)).without(mmbrdf.Aperture.cone(60, 0, 5)),
    ]
    ptfe = mmbrdf.material("ptfe-532")
    for shape in shapes:
        for same in (pickle.loads(pickle.dumps(shape)), copy.copy(shape)):
            assert repr(same) == repr(shape) and same.projected_solid_angle == shape.projected_solid_angle
            there, here = (mmbrdf.average(ptfe, 532, mmbrdf.Aperture.direction(8), one, 1e-3) for one in (same, shape))
            np.testing.assert_array_equal(there[0], here[0])


def test_analyze_is_everything_at_once(ptfe):
    question = {"wavelength_nm": [[532], [633]], "theta_i_deg": 45, "phi_i_deg": 0,
                "theta_r_deg": [0, 30, 60], "phi_r_deg": 170}  # fmt: skip
    terms, light = {"scale": 0.003, "theta_r_deg": 0.02}, [1, 0.5, 0, -0.5]
    analyzed = ptfe.analyze(**question, frame="sp", terms=terms, stokes=light)
    m, v = ptfe.evaluate(**question, frame="sp"), ptfe.covariance(**question, frame="sp", terms=terms)
    assert list(analyzed) == [q.name for q in mmbrdf.quantities()]
    for q in mmbrdf.quantities():
        arguments = (m, light) if q.takes_light else (m,)
        gradient = getattr(mmbrdf, q.name + "_gradient")(*arguments)
        a = analyzed[q.name]
        np.testing.assert_array_equal(a.value, getattr(mmbrdf, q.name)(*arguments))
        np.testing.assert_allclose(a.u, mmbrdf.standard_uncertainty(gradient, v), rtol=1e-12)
        assert list(a.parts) == [*OF_THE_SAMPLE, *terms]
        np.testing.assert_allclose(together(a.parts), a.u, rtol=1e-9)
        assert np.isnan(a.low).all() and np.isnan(a.high).all()


def test_analyze_has_intervals_from_draws(ptfe):
    analyzed = ptfe.analyze(532, 45, 0, [0, 30], 180, draws=200, seed=3)
    d = mmbrdf.depolarization(ptfe.evaluate_draws(200, 3, 532, 45, 0, [0, 30], 180))
    np.testing.assert_allclose(analyzed["depolarization"].u, d.std(axis=0, ddof=1), rtol=1e-9)
    assert (analyzed["depolarization"].low < analyzed["depolarization"].value).all()
    assert np.isnan(analyzed["f_ss"].low).all() and "degree_of_polarization" not in analyzed


def test_analyze_has_nan_where_there_is_no_number(ptfe):
    with pytest.warns(mmbrdf.ExtrapolationWarning):
        analyzed = ptfe.analyze(2000, 90, 0, 90, 0)
    assert np.isnan(analyzed["depolarization"].value) and analyzed["f_ss"].value < 0
    with pytest.raises(ValueError, match="cannot exist"):
        ptfe.analyze(532, 45, 0, 30, 180, stokes=[1, 1, 1, 0])


def test_matrices_without_an_answer_are_counted_or_become_nan():
    matrices = np.tile(np.diag([1.0, 0.8, 0.7, 0.6]), (3, 4, 1, 1))
    matrices[1, 2, 0, 0] = -1
    matrices[2, 3, 1, 1] = np.nan
    refused = np.zeros((3, 4), bool)
    refused[1, 2] = refused[2, 3] = True
    for function in [mmbrdf.purity, mmbrdf.depolarization_ratio, mmbrdf.entropy, mmbrdf.diattenuation_vector]:
        answers = function(matrices, invalid="nan")
        has_none = np.isnan(answers) if answers.ndim == 2 else np.isnan(answers).all(axis=-1)
        assert has_none[1, 2] and not has_none[~refused].any()
    for factor in mmbrdf.lu_chipman(matrices, invalid="nan"):
        np.testing.assert_array_equal(np.isnan(factor).all(axis=(-1, -2)), refused)
    nearest = mmbrdf.nearest_realizable(matrices, invalid="nan")
    np.testing.assert_array_equal(np.isnan(nearest).all(axis=(-1, -2)), refused)
    np.testing.assert_array_equal(mmbrdf.realizable(matrices, invalid="nan")[2], [True, True, True, False])
    with pytest.raises(ValueError, match=r"M11 = -1, must be positive, at \[1, 2\]; 2 matrices have no answer"):
        mmbrdf.purity(matrices)
    with pytest.raises(ValueError, match="invalid = 'skip', must be 'raise' or 'nan'"):
        mmbrdf.purity(matrices, invalid="skip")


def test_a_large_array_has_the_bits_of_its_matrices_one_by_one():
    rng = np.random.default_rng(1)
    matrices = np.diag([1.0, 0.6, 0.5, 0.4]) + 0.05 * rng.normal(size=(300, 70, 4, 4))
    for function in [mmbrdf.entropy, mmbrdf.realizable, mmbrdf.nearest_realizable, mmbrdf.coherency_eigenvalues]:
        whole = function(matrices)
        for place in [(0, 0), (299, 69), (17, 33)]:
            np.testing.assert_array_equal(function(matrices[place]), whole[place])
        np.testing.assert_array_equal(function(matrices[::3, ::-2]), whole[::3, ::-2])
