# SPDX-License-Identifier: BSD-3-Clause
"""Sunlight in a layer of small particles over a surface: discrete ordinates without moments of the one or the other, from fields
about the axes s and p of every beam. Stokes vectors are those of the library."""
import numpy as np

STOKES = np.array([[1, 0, 0, 1], [1, 0, 0, -1], [0, 1, 1, 0], [0, 1j, -1j, 0]])  # of E1 E1*, E1 E2*, E2 E1*, E2 E2*


def axes(u, phi):
    """s = z x k / |z x k| and p = k x s of beams that travel along k, of the cosine u and the azimuth phi; shape (..., 3)."""
    u, phi = np.broadcast_arrays(u, phi)
    sine = np.sqrt(1 - u**2)
    s = np.stack([-np.sin(phi), np.cos(phi), np.zeros_like(u)], -1)
    return s, np.cross(np.stack([sine * np.cos(phi), sine * np.sin(phi), u], -1), s)


def scattered(electric, magnetic, u, u_in, phi):
    """Mueller matrices (..., 4, 4) of particles that answer as an electric and a magnetic dipole along the fields, phi the
    azimuth between the beams; the mean of element 11 over all directions is 1."""
    (s, p), (s_in, p_in) = axes(u, phi), axes(u_in, 0 * phi)
    ss, sp, ps, pp = (np.sum(out * incident, -1) for out in (s, p) for incident in (s_in, p_in))
    jones = electric * np.array([[ss, sp], [ps, pp]]) + magnetic * np.array([[pp, -ps], [-sp, ss]])
    products = np.einsum("ac...,bd...->...abcd", jones, jones.conj()).reshape(*ss.shape, 4, 4)
    mean = 2 / 3 * (abs(electric) ** 2 + abs(magnetic) ** 2)
    return (STOKES @ products @ np.linalg.inv(STOKES)).real / mean


def harmonics(of, u, u_in, count):
    """For each frequency in azimuth the matrix (4 u, 4 u_in) that takes Stokes vectors of all u_in to those of all u."""
    matrices = of(u[:, None, None], u_in[None, :, None], 2 * np.pi * np.arange(count) / count)
    return np.fft.fft(matrices, axis=2).transpose(2, 0, 3, 1, 4).reshape(count, 4 * len(u), 4 * len(u_in))


def leaving(change, source, reflected, bounced, depth, sun):
    """What goes up at the top where dI/d(depth) = change I - source e^(-depth/sun), nothing comes down there, and at the bottom
    up = reflected down + bounced."""
    down = reflected.shape[1]
    particular = np.linalg.solve(change + np.eye(len(change)) / sun, source)
    below = np.exp(-depth / sun) * particular
    rates, modes = np.linalg.eig(change)
    grows = rates.real > 0
    top = modes * np.exp(np.where(grows, -rates * depth, 0))  # 1 where each is largest
    bottom = modes * np.exp(np.where(grows, 0, rates * depth))
    conditions = np.concatenate([top[:down], bottom[down:] - reflected @ bottom[:down]])
    given = np.concatenate([-particular[:down], bounced + reflected @ below[:down] - below[down:]])
    return (top @ np.linalg.solve(conditions, given) + particular)[down:]


def radiance(brdf, layer, streams, sun, views, azimuths, highest, count=32):
    """Stokes vectors (azimuth, view, 4) that leave the top, of a sun of irradiance 1 across its beam. layer is (optical depth,
    single-scattering albedo, electric, magnetic); sun and views are cosines, azimuths those of travel from the sun's;
    brdf(mu_i, mu_r, phi) gives matrices in sp. What depends on azimuth with a frequency above the highest is left out;
    `count` azimuths carry those below count / 2."""
    depth, albedo, *dipoles = layer
    nodes, weights = np.polynomial.legendre.leggauss(streams)
    mu, weights = (nodes + 1) / 2, weights / 2
    up = np.concatenate([mu, views])  # views take part without a weight
    u = np.concatenate([-mu, up])
    gains = np.repeat(np.concatenate([weights, weights, 0 * views]), 4)
    phase = harmonics(lambda *beams: scattered(*dipoles, *beams), u, np.append(u, -sun), count)
    surface = harmonics(lambda u_r, u_i, phi: brdf(u_i, u_r, phi), up, np.append(mu, sun), count)
    total = 0
    for frequency, scatters, reflects in zip(np.fft.fftfreq(count, 1 / count), phase, surface):
        if abs(frequency) > highest:
            continue
        change = (np.eye(len(gains)) - albedo / 2 / count * scatters[:, :-4] * gains) / np.repeat(u, 4)[:, None]
        source = albedo / 4 / np.pi * scatters[:, -4] / np.repeat(u, 4)
        reflected = 2 * np.pi / count * reflects[:, :-4] * np.repeat(weights * mu, 4)
        bounced = sun * np.exp(-depth / sun) * reflects[:, -4]
        stokes = leaving(change, source, reflected, bounced, depth, sun)[4 * streams :].reshape(-1, 4)
        total = total + np.exp(1j * frequency * azimuths)[:, None, None] * stokes / count
    return total.real
