# SPDX-License-Identifier: BSD-3-Clause
"""PythonicDISORT over a surface given as pythonic_disort_modes: the radiance that leaves through an empty atmosphere is mu0 I0 f."""
import sys

import numpy as np
import peer

import mmbrdf

WAVELENGTH, STREAMS, DEPTH = 532, 32, 1e-12
REST = 1e-8  # that atmosphere takes DEPTH / mu, and the solver loses digits in it


def main():
    sys.path.append(*peer.command("MMBRDF_PEER_PYTHONICDISORT", "the folder that holds the package PythonicDISORT"))
    from PythonicDISORT.pydisort import pydisort

    model = mmbrdf.material("ptfe")
    modes = mmbrdf.pythonic_disort_modes(model, WAVELENGTH, streams=STREAMS)
    random = np.random.default_rng(1)
    deviations = []
    for theta_i in random.uniform(1, 89, 8):
        mu0, azimuth = np.cos(np.radians(theta_i)), random.uniform(-180, 180, 8)
        isotropic = np.eye(1, STREAMS)
        solved = pydisort(
            np.array([DEPTH]), np.array([DEPTH]), STREAMS, isotropic, mu0, 1.0, 0.0, BDRF_Fourier_modes=modes
        )
        mu, radiance = solved[0][: STREAMS // 2], solved[-1](0, np.radians(azimuth))[: STREAMS // 2]
        # Its azimuth 0 is forward, where phi_r - phi_i is 180 degrees.
        theta_r, phi_r = np.degrees(np.arccos(mu))[:, None], azimuth + 180
        f11 = model.evaluate(WAVELENGTH, theta_i, 0, theta_r, phi_r)[..., 0, 0]
        deviations.append((radiance / mu0 / f11 - 1).ravel())
    what = f"reflected radiance, NQuad {STREAMS}"
    peer.judge("PythonicDISORT", what, np.concatenate(deviations), REST, REST)


main()
