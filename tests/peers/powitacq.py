# SPDX-License-Identifier: BSD-3-Clause
"""powitacq, RGL's own loader, on an RGL .bsdf: it answers with f cos(theta_r)."""
import pathlib
import tempfile

import numpy as np
import peer

import mmbrdf

WAVELENGTH = 532
PRECISION = 1e-5  # single, over some ten steps


def main():
    ask = peer.command("MMBRDF_PEER_POWITACQ", "a program that answers lines 'nm light viewer' from powitacq::BRDF::eval")
    model = mmbrdf.material("ptfe")
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "ptfe.bsdf"
        rms, largest, limit = peer.interpolation(model.export(file, "rgl", wavelength_nm=[450, WAVELENGTH, 650]))
        theta_i, phi_i, theta_r, phi_r = peer.geometries(limit)
        light, viewer = peer.direction(theta_i, phi_i), peer.direction(theta_r, phi_r)
        answers = peer.ask(ask + [str(file)], np.column_stack([np.full_like(theta_i, WAVELENGTH), light, viewer]))
    f11 = model.evaluate(WAVELENGTH, theta_i, phi_i, theta_r, phi_r)[:, 0, 0]
    deviations = answers[:, 0] / viewer[:, 2] / f11 - 1
    peer.judge("powitacq", "RGL .bsdf, f11", deviations, rms + PRECISION, largest + PRECISION)


main()
