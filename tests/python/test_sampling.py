# SPDX-License-Identifier: BSD-3-Clause
"""Directions that are drawn, over arrays."""

import warnings

import numpy as np
import pytest

import mmbrdf


@pytest.fixture(scope="module")
def sampler(ptfe):
    return mmbrdf.DirectionSampler(ptfe, 532)


@pytest.mark.filterwarnings("ignore::mmbrdf.ExtrapolationWarning")
def test_the_mean_weight_is_the_reflectance_of_polarized_light(ptfe, sampler):
    u1, u2 = np.meshgrid((np.arange(192) + 0.5) / 192, (np.arange(192) + 0.5) / 192)
    drawn = sampler.sample(60, 0, u1, u2)
    assert drawn.pdf.shape == (192, 192)
    weights = sampler.weight(60, 0, *drawn, frame="sp")
    for stokes in ([1, 0, 0, 0], [1, 1, 0, 0], [1, -1, 0, 0], [1, 0, 0, 1]):
        expected = mmbrdf.directional_hemispherical_reflectance(ptfe, 532, 60, 0, stokes)
        assert (weights @ stokes)[..., 0].mean() == pytest.approx(expected, abs=1e-4)  # a midpoint rule
    f = ptfe.evaluate(532, 60, 0, drawn.theta_r_deg, drawn.phi_r_deg, frame="sp")
    cosine = np.cos(np.radians(drawn.theta_r_deg))
    np.testing.assert_allclose(weights, f * (cosine / drawn.pdf)[..., None, None], rtol=1e-9, atol=1e-12)


def test_the_pdf_is_that_of_what_was_drawn(sampler):
    u = np.random.default_rng(1).random((2, 1000))
    theta_i, phi_i = np.linspace(-90, 90, 1000), np.linspace(-400, 400, 1000)
    drawn = sampler.sample(theta_i, phi_i, *u)
    np.testing.assert_allclose(sampler.pdf(theta_i, phi_i, drawn.theta_r_deg, drawn.phi_r_deg), drawn.pdf, rtol=1e-8)


def test_numbers_give_numbers_and_arrays_broadcast(sampler):
    one = sampler.sample(30, 10, 0.25, 0.75)
    assert all(isinstance(value, float) for value in one)
    many = sampler.sample([[30.0], [40.0]], 10, 0.25, [0.5, 0.75])
    assert many.theta_r_deg.shape == (2, 2)
    assert (many.theta_r_deg[0, 1], many.phi_r_deg[0, 1], many.pdf[0, 1]) == one
    assert sampler.sample(30, 10, np.empty(0), 0.5).pdf.shape == (0,)


def test_what_makes_no_sense_is_refused_with_its_place(sampler, ptfe):
    with pytest.raises(ValueError, match=r"u = \(1, 0.5\): both must be in \[0, 1\), at \[1\]"):
        sampler.sample(30, 0, [0.5, 1.0], 0.5)
    with pytest.raises(ValueError, match="95"):
        sampler.sample(95, 0, 0.5, 0.5)
    with pytest.raises(ValueError, match="pdf = 0"):
        sampler.weight(30, 0, 10, 0, 0)
    with pytest.raises(ValueError, match="frame"):
        sampler.weight(30, 0, 10, 0, 0.3, frame="lab")
    with pytest.raises(ValueError, match="wavelength"):
        mmbrdf.DirectionSampler(ptfe, -1)
    with pytest.raises(TypeError):
        mmbrdf.DirectionSampler(None, 532)
    with pytest.raises(ValueError, match=r"pdf = -1.*at \[600\]"):
        sampler.weight(30, 0, 10, 0, np.where(np.arange(1000) == 600, -1, 0.3))
    with pytest.raises(ValueError, match=r"phi_r_deg is not finite, at \[600\]"):
        sampler.weight(30, 0, 10, np.where(np.arange(1000) == 600, np.nan, 0), 0.3)
    with pytest.raises(ValueError, match=r"200.*at \[1\]"):
        sampler.pdf(30, 0, [120, 200], 0)
    with pytest.raises(ValueError, match="120"):
        sampler.pdf(120, 0, 30, 0)
    with pytest.raises(ValueError, match="phi_r"):
        sampler.pdf(30, 0, 120, np.nan)


def test_directions_below_the_horizon_are_never_drawn(sampler):
    np.testing.assert_array_equal(sampler.pdf(30, 0, [-180, -91, 90.5, 180], 20), 0)
    assert sampler.pdf(30, 0, 89.9, 20) > 0


def test_weights_warn_of_what_lies_outside_the_fitted_range(ptfe, sampler):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sampler.weight([60, 74], 0, 30, 0, 0.3)
    with pytest.warns(mmbrdf.ExtrapolationWarning, match=r"ptfe: 2 of 3 questions lie outside .*\(theta_i\)"):
        sampler.weight([60, 80, -85], 0, 30, 0, 0.3)
    with pytest.warns(mmbrdf.ExtrapolationWarning, match="wavelength"):
        mmbrdf.DirectionSampler(ptfe, 2000).weight(60, 0, 30, 0, 0.3)


def test_weights_of_arrays_have_the_bits_of_one_at_a_time(sampler):
    theta_i, pdf = np.linspace(0, 70, 700)[:, None], np.array([0.1, 0.3])
    many = sampler.weight(theta_i, 10, 30, 50, pdf, frame="sp")
    assert many.shape == (700, 2, 4, 4)
    for i in range(0, 700, 23):
        np.testing.assert_array_equal(many[i, 1], sampler.weight(theta_i[i, 0], 10, 30, 50, 0.3, frame="sp"))
    assert sampler.weight(np.empty(0), 0, 0, 0, 1).shape == (0, 4, 4)
