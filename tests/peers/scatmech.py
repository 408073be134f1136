# SPDX-License-Identifier: BSD-3-Clause
"""SCATMECH's ZernikeExpansion_BRDF_Model on the coefficients that a model is written as: all sixteen elements, in its frame xyxy."""
import json
import pathlib
import tempfile

import numpy as np
import peer

import mmbrdf

WAVELENGTH = 532
ROUNDING = 1e-13  # of sums of some hundred terms in double precision, in another order

ASK = """
import sys
from pySCATMECH.brdf import BRDF_Model
file, wavelength, scale = sys.argv[1:]
model = BRDF_Model("ZernikeExpansion_BRDF_Model", {"lambda": wavelength, "coefficientfile": file, "scale": scale})
for line in sys.stdin:
    theta_i, theta_r, phi, rotation = map(float, line.split())
    m = model.MuellerBRDF(theta_i, theta_r, phi, rotation, "xyxy")
    print(*(repr(float(m[i][j])) for i in range(4) for j in range(4)))
"""


def ask(python, file, geometry, scale):
    theta_i, phi_i, theta_r, phi_r = geometry
    rows = np.radians(np.column_stack([theta_i, theta_r, phi_r - phi_i + 180, 180 - phi_i]))  # phis = 0 is forward
    return peer.ask(python + ["-c", ASK, str(file), str(WAVELENGTH / 1000), repr(scale)], rows).reshape(-1, 4, 4)


def reflectance(model):
    """What a coefficient file has no place for: f11 is divided by it there."""
    table = json.loads(model.to_json())["reflectance"]
    return float(np.interp(WAVELENGTH / 1000, table["wavelengths_um"], table["values"]))


def main():
    python = peer.command("MMBRDF_PEER_PYSCATMECH", "a python that imports pySCATMECH")
    version = peer.run(python + ["-c", "from importlib.metadata import version; print(version('pySCATMECH'))"]).strip()
    model = mmbrdf.material("ptfe")
    where = peer.geometries(74.9)
    # SCATMECH turns the sample, not the source, and its sum is as printed: an isotropic sample is asked unturned.
    unturned = where[0], np.full_like(where[1], 180), where[2], where[3]
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "ptfe.csv"
        model.save(file)
        written = mmbrdf.load_model(file)
        m = np.concatenate([model.evaluate(WAVELENGTH, *unturned), written.evaluate(WAVELENGTH, *where, as_printed=True)])
        answers = np.concatenate([ask(python, file, unturned, reflectance(model)), ask(python, file, where, 1)])
    deviations = ((answers - m) / m[:, :1, :1]).reshape(len(m), 16)
    peer.judge(f"pySCATMECH {version}", "ZernikeExpansion_BRDF_Model, 16 elements", deviations, ROUNDING, ROUNDING)


main()
