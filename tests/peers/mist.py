# SPDX-License-Identifier: BSD-3-Clause
"""MIST, by its input file, on the coefficients that a model is written as: its differential is f cos(theta_s), all sixteen elements."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
import peer

import mmbrdf

WAVELENGTH = 532
ROUNDING = 1e-13  # of sums of some hundred terms in double precision, in another order
UNITS = ["(1,0,0,0)", "(0,1,0,0)", "(0,0,1,0)", "(0,0,0,1)"]

INPUT = """MODEL = ZernikeExpansion_BRDF_Model
VARIABLES:
  thetai = 0
  thetas = 0
  phis = 0
  #quiet = 1
  minsamples = 1
  differential = 1
  incidentangle = thetai
  incidentpol = (1,0,0,0)
  rotation = 0
  #lambda = {wavelength}
  #type = 0
  $coefficientfile = "coefficients.csv"
  #scale = {scale}
END
VARY:
  LIST geometries.txt
END
INTEGRALS:
{integrals}END
OUTPUTS:
{outputs}END
FILES:
  results = results.txt
  basis = xyxy
  format = "%.17g\\t"
END
"""


def main():
    program = peer.command("MMBRDF_PEER_MIST", "the program of MIST")
    model = mmbrdf.material("ptfe")
    table = json.loads(model.to_json())["reflectance"]  # a coefficient file has no place for it
    scale = float(np.interp(WAVELENGTH / 1000, table["wavelengths_um"], table["values"]))
    theta_i, _, theta_r, phi_r = peer.geometries(74.9)
    pairs = [(row, column) for row in range(4) for column in range(4)]
    integrals = "".join(
        f"  e{r}{c} = DIFFERENTIAL CENTER = (thetas,phis) INPOL = {UNITS[c]} POL = {UNITS[r]} END\n" for r, c in pairs
    )
    outputs = "".join(f"  {n + 1} e{r}{c}\n" for n, (r, c) in enumerate(pairs))
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        model.save(folder / "coefficients.csv")
        rows = np.radians(np.column_stack([theta_i, theta_r, phi_r]))  # phis = 0 is forward, where phi_r - phi_i is 180
        np.savetxt(folder / "geometries.txt", rows, "%.17g", header="thetai thetas phis", comments="")
        text = INPUT.format(wavelength=WAVELENGTH / 1000, scale=repr(scale), integrals=integrals, outputs=outputs)
        (folder / "input.txt").write_text(text)
        run = {"cwd": folder, "input": "\n", "text": True, "capture_output": True}  # after an error it waits for a return
        said = subprocess.run(program + ["input.txt"], **run).stderr
        results = folder / "results.txt"
        if not results.exists():  # its exit status is 0 then, too
            sys.exit(said)
        answers = np.loadtxt(results, skiprows=1)[:, -16:].reshape(-1, 4, 4)
    m = model.evaluate(WAVELENGTH, theta_i, 180, theta_r, phi_r)
    deviations = answers / np.cos(rows[:, 1])[:, None, None] - m
    version = re.search(r"Version (\S+)", said).group(1)
    peer.judge(f"MIST {version}", "differential / cos, 16 elements", deviations.reshape(len(m), 16) / m[:, 0, :1], ROUNDING, ROUNDING)


main()
