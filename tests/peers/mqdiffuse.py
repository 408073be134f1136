# SPDX-License-Identifier: BSD-3-Clause
"""eradiate's mqdiffuse, the plugin of its kernel behind the table that its loader makes of a NetCDF file."""
import pathlib
import tempfile

import numpy as np
import peer

import mmbrdf

WAVELENGTH = 532
PRECISION = 1e-5  # single, over some ten steps


def main():
    ask = peer.command("MMBRDF_PEER_MQDIFFUSE", "a program that answers lines 'nm light viewer' from mqdiffuse's BSDF::eval")
    model = mmbrdf.material("ptfe")
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "ptfe.nc"
        rms, largest, limit = peer.interpolation(model.export(file, "mqdiffuse", wavelength_nm=WAVELENGTH))
        theta_i, phi_i, theta_r, phi_r = peer.geometries(limit)
        light, viewer = peer.direction(theta_i, phi_i), peer.direction(theta_r, phi_r)
        answers = peer.ask(ask + [str(file)], np.column_stack([np.full_like(theta_i, WAVELENGTH), light, viewer]))
    f11 = model.evaluate(WAVELENGTH, theta_i, phi_i, theta_r, phi_r)[:, 0, 0]
    # It multiplies by the cosine of its wo, the light, as Mitsuba does.
    deviations = answers[:, 0] / light[:, 2] / f11 - 1
    peer.judge("eradiate mqdiffuse", "NetCDF, f11", deviations, rms + PRECISION, largest + PRECISION)


main()
