# SPDX-License-Identifier: BSD-3-Clause
"""Radiance's bsdfquery on XML with the patches of Klems: means over patches, so far from the model as its export says."""
import pathlib
import tempfile

import numpy as np
import peer

import mmbrdf

WAVELENGTH = 532


def main():
    ask = peer.command("MMBRDF_PEER_BSDFQUERY", "Radiance's bsdfquery")
    model = mmbrdf.material("ptfe")
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "ptfe.xml"
        rms, largest, limit = peer.interpolation(model.export(file, wavelength_nm=WAVELENGTH))
        theta_i, phi_i, theta_r, phi_r = peer.geometries(limit)
        light, viewer = peer.direction(theta_i, phi_i), peer.direction(theta_r, phi_r)
        answers = peer.ask(ask + [str(file)], np.column_stack([light, viewer]))
    f11 = model.evaluate(WAVELENGTH, theta_i, phi_i, theta_r, phi_r)[:, 0, 0]
    peer.judge("Radiance bsdfquery", "Klems XML, f11", answers[:, 0] / f11 - 1, rms, largest)


main()
