# SPDX-License-Identifier: BSD-3-Clause
"""VLIDORT's BRDF supplement: for a Lambertian surface it fills the five arrays with the numbers of an export, in its order."""
import pathlib
import tempfile

import numpy as np
import peer

import mmbrdf

ALBEDO, STREAMS, SUNS, VIEWS, AZIMUTHS = 0.3, 8, [0, 30, 60, 80], [0, 15, 40, 75], [0, 45, 90, 135, 180]


def after_the_header(text):
    """Numbers of an export behind its lines of text, cosines with weights, and angles."""
    lines = text.splitlines()
    texts, _, streams, _, suns, views, azimuths = map(int, lines[0].split())
    numbers = np.array(" ".join(lines[1 + texts :]).split(), float)
    return lines[0].split(), numbers[2 * streams + suns + views + azimuths :]


def main():
    ask = peer.command("MMBRDF_PEER_VLIDORT", "a program that answers with the arrays of VBRDF_MAINMASTER")
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "lambertian.vlidort"
        options = {"streams": STREAMS, "sun_deg": SUNS, "view_deg": VIEWS, "azimuth_deg": AZIMUTHS}
        peer.lambertian(ALBEDO).export(file, "vlidort", wavelength_nm=500, **options)
        counts, found = after_the_header(file.read_text())
    angles = "\n".join(" ".join(map(str, degrees)) for degrees in (SUNS, VIEWS, AZIMUTHS))
    surface = f"{' '.join(counts[1:])}\n{angles}\nLambertian 1 {ALBEDO} 0 0 0 0 0\n"
    expected = np.array(peer.run(ask, input=surface).split(), float)
    assert found.shape == expected.shape, (found.shape, expected.shape)
    deviations = (found - expected) / ALBEDO
    peer.judge("VLIDORT", "BRDF supplement, Lambertian", deviations, 1e-15, 1e-15, "numbers of its five arrays")


main()
