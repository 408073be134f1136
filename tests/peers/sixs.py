# SPDX-License-Identifier: BSD-3-Clause
"""6SV 1.1 over a surface from an export: its own answer for a Lambertian, what it prints of the scene for others, and by Py6S."""
import os
import pathlib
import re
import sys
import tempfile

import numpy as np
import peer

import mmbrdf

SCENES = 50  # each is a run of a second
DIGITS = 1e-4  # it prints four decimals of reflectances, which enter with half of the last
SIX_DECIMALS = 2e-6  # with which Py6S writes tables


def answer(ask, surface, sun, view, azimuth):
    """What it prints for a sun, a view and a surface, below an atmosphere without aerosol and absorption, at 532 nm."""
    return peer.run(ask, input=f"0\n{sun} 0 {view} {azimuth} 7 1\n0\n0\n-1\n0\n-1000\n-1\n0.532\n{surface}\n-2\n")


def apparent(text):
    return float(re.search(r"apparent reflectance +([\d.]+)", text).group(1))


def by_py6s(Py6S, ask, surface, sun, view, azimuth):
    """The apparent reflectance of the same scene, with the surface as Py6S takes it."""
    scene = Py6S.SixS(*ask)
    scene.geometry = Py6S.Geometry.User()
    scene.geometry.solar_z, scene.geometry.solar_a, scene.geometry.view_z, scene.geometry.view_a = sun, 0, view, azimuth
    scene.geometry.month, scene.geometry.day = 7, 1
    scene.atmos_profile = Py6S.AtmosProfile.PredefinedType(Py6S.AtmosProfile.NoGaseousAbsorption)
    scene.aero_profile = Py6S.AeroProfile.PredefinedType(Py6S.AeroProfile.NoAerosols)
    scene.wavelength = Py6S.Wavelength(0.532)
    scene.altitudes.set_target_sea_level()
    scene.altitudes.set_sensor_satellite_level()
    scene.ground_reflectance = Py6S.GroundReflectance.HomogeneousUserDefined(**surface)
    scene.run()
    return scene.outputs.apparent_reflectance


def main():
    ask = peer.command("MMBRDF_PEER_6S", "the program of 6SV 1.1")
    random = np.random.default_rng(1)
    models = {"lambertian": peer.lambertian(0.3), "ptfe": mmbrdf.material("ptfe-532")}
    own, scene, python = [], [], []
    if os.environ.get("MMBRDF_PEER_PY6S"):
        sys.path.append(os.environ["MMBRDF_PEER_PY6S"])
        import Py6S
    else:
        Py6S = None
        print("without Py6S: set MMBRDF_PEER_PY6S to the folder that holds the package")
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
            if Py6S:
                angles = {"sun_deg": sun, "view_deg": view, "azimuth_deg": azimuth}
                surface = mmbrdf.py6s_surface(models["ptfe"], 532, **angles)
                python.append(by_py6s(Py6S, ask, surface, sun, view, azimuth) / apparent(text["ptfe"]) - 1)
    peer.judge("6SV 1.1", "apparent reflectance, Lambertian as a table against its own", own, 1e-6, 1e-6)
    peer.judge("6SV 1.1", "reflectance of the scene, ptfe", scene, DIGITS, DIGITS)
    if Py6S:
        peer.judge("Py6S", "apparent reflectance, ptfe, against the export", python, SIX_DECIMALS, SIX_DECIMALS)


main()
