# SPDX-License-Identifier: BSD-3-Clause
"""6SV 1.1 over a surface from an export: its own answer for a Lambertian, and what it prints of the scene for others."""
import pathlib
import re
import tempfile

import numpy as np
import peer

import mmbrdf

SCENES = 50  # each is a run of a second
DIGITS = 1e-4  # it prints four decimals of reflectances, which enter with half of the last


def answer(ask, surface, sun, view, azimuth):
    """What it prints for a sun, a view and a surface, below an atmosphere without aerosol and absorption, at 532 nm."""
    return peer.run(ask, input=f"0\n{sun} 0 {view} {azimuth} 7 1\n0\n0\n-1\n0\n-1000\n-1\n0.532\n{surface}\n-2\n")


def apparent(text):
    return float(re.search(r"apparent reflectance +([\d.]+)", text).group(1))


def main():
    ask = peer.command("MMBRDF_PEER_6S", "the program of 6SV 1.1")
    random = np.random.default_rng(1)
    models = {"lambertian": peer.lambertian(0.3), "ptfe": mmbrdf.material("ptfe-532")}
    own, scene = [], []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(SCENES):
            sun, view, azimuth = (round(float(x), 1) for x in random.uniform([0, 0, 0], [70, 70, 360]))
            text = {}
            for name, model in models.items():
                file = pathlib.Path(folder) / f"{name}.6s"
                # Its azimuth is that of the view less that of the sun, and 0 is the side of the sun.
                model.export(file, "6s", wavelength_nm=532, sun_deg=[sun], view_deg=[view], azimuth_deg=[azimuth])
                text[name] = answer(ask, file.read_text().rstrip(), sun, view, azimuth)
            own.append(apparent(text["lambertian"]) / apparent(answer(ask, "0\n0\n0\n0.3", sun, view, azimuth)) - 1)
            rodir = float(re.search(r"albedo +\*\s*\* +([\d.]+)", text["ptfe"]).group(1))
            f11 = models["ptfe"].evaluate(532, sun, 0, view, azimuth)[0, 0]
            scene.append(rodir / np.pi / f11 - 1)
    peer.judge("6SV 1.1", "apparent reflectance, Lambertian as a table against its own", own, 1e-6, 1e-6)
    peer.judge("6SV 1.1", "reflectance of the scene, ptfe", scene, DIGITS, DIGITS)


main()
