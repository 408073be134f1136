# SPDX-License-Identifier: BSD-3-Clause
"""Directions that are drawn, over arrays."""

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
