# SPDX-License-Identifier: BSD-3-Clause
"""Mitsuba's measured_polarized on a .pbsdf, all sixteen elements in Mitsuba's own frames, and its measured on an RGL .bsdf."""
import pathlib
import tempfile

import numpy as np
import peer

import mmbrdf

WAVELENGTHS = [450, 532, 650]
PRECISION = 1e-4  # of a node's scale: Mitsuba looks up in single precision


def basis(k):
    """Mitsuba's implicit first axis of a beam along k: of the frame that turns z into k (Duff et al., JCGT 6, 2017)."""
    x, y, z = np.moveaxis(k, -1, 0)
    sign = np.copysign(1.0, z)
    a = -1 / (sign + z)
    return np.stack([1 + sign * x * x * a, sign * x * y * a, -sign * x], -1)


def rotator(theta_phi, k):
    """Stokes parameters about (s, p) to those about Mitsuba's axis, for beams along k."""
    phi = np.radians(theta_phi[1])
    sense = np.where(k[..., 2] > 0, 1, -1)  # s = z x k / |z x k| of light that arrives is opposite to that of its source
    s = sense[..., None] * np.stack([-np.sin(phi), np.cos(phi), 0 * phi], -1)
    p = np.cross(k, s)
    axis = basis(k)
    angle = 2 * np.arctan2((axis * p).sum(-1), (axis * s).sum(-1))
    r = np.zeros(angle.shape + (4, 4))
    r[..., 0, 0] = r[..., 3, 3] = 1
    r[..., 1, 1] = r[..., 2, 2] = np.cos(angle)
    r[..., 1, 2] = np.sin(angle)
    r[..., 2, 1] = -np.sin(angle)
    return r


def asked(ask, model, name, format):
    """Where it was asked, and its answers over the cosine that it multiplies by, that of the light; and limits."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / name
        rms, largest, limit = peer.interpolation(model.export(file, format, wavelength_nm=WAVELENGTHS))
        where = peer.geometries(limit)
        nm = np.resize(WAVELENGTHS, where[0].shape)
        light, viewer = peer.direction(*where[:2]), peer.direction(*where[2:])
        answers = peer.ask(ask + [str(file)], np.column_stack([nm, light, viewer]))
    m = model.evaluate(nm, *where, frame="sp")
    return where, answers.reshape(-1, 4, 4) / light[:, 2, None, None], m, rms + PRECISION, largest + PRECISION


def main():
    ask = peer.command("MMBRDF_PEER_MITSUBA", "a program that answers lines 'nm light viewer' from Mitsuba's BSDF::eval")
    version = peer.run(ask + ["--version"]).strip()
    model = mmbrdf.material("ptfe")

    where, answers, m, rms, largest = asked(ask, model, "ptfe.pbsdf", "pbsdf")
    right = np.diag([1, 1, 1, -1])  # S4 > 0 is right-handed there
    into, out = rotator(where[:2], -peer.direction(*where[:2])), rotator(where[2:], peer.direction(*where[2:]))
    expected = right @ out @ m @ np.swapaxes(into, -1, -2) @ right
    deviations = ((answers - expected) / m[:, :1, :1]).reshape(len(m), 16)
    peer.judge(version, "measured_polarized, 16 elements", deviations, rms, largest)

    _, answers, m, rms, largest = asked(ask, model, "ptfe.bsdf", "rgl")
    peer.judge(version, "measured, f11", answers[:, 0, 0] / m[:, 0, 0] - 1, rms, largest)


main()
