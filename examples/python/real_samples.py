#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Do the intervals of one measurement hold in another? Two published measurements of one sample, each fitted alone.

    python3 real_samples.py DATA_FOLDER PICTURE.png

DATA_FOLDER holds PTFE.data.csv and PTFE.data.random.csv (figshare 10.6084/m9.figshare.5417410). The picture shows the
difference of the two fits over its standard uncertainty for light from 45 degrees: above with the uncertainty of the
noise, below with that of the sample and the errors that the two measurements are known to differ by.
"""
from __future__ import annotations

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import mmbrdf

DECLARED = {"scale": 0.003, "source_deg": 0.5, "receiver_deg": 0.5}
ELEMENTS = ["11", "22", "34", "44"]


def differences(folder: Path, directions, **options) -> np.ndarray:
    """(fit of the grid - fit of the random directions) / u at 532 nm, a matrix for each direction."""
    models = [
        mmbrdf.fit(mmbrdf.load(folder / name).at_wavelengths(532), **options).model
        for name in ["PTFE.data.csv", "PTFE.data.random.csv"]
    ]
    first, second = [model.evaluate(532, *directions) for model in models]
    u = np.hypot(*[model.evaluate_uncertainty(532, *directions) for model in models])
    return np.divide(first - second, u, out=np.zeros_like(u), where=u > 0)  # 0 where symmetry leaves no element


def main(folder: Path, picture: Path) -> None:
    theta, phi = np.meshgrid(np.linspace(1, 70, 24), np.linspace(0, 360, 49), indexing="ij")
    directions = (45.0, 0.0, theta, phi)
    rows = {
        "noise": differences(folder, directions, uncertainty="noise", weights="speckle"),
        "sample, declared errors": differences(folder, directions, declared=DECLARED),
    }
    figure, axes = plt.subplots(2, 4, subplot_kw={"projection": "polar"}, figsize=(8.4, 4.6), layout="constrained")
    for line, (name, z) in zip(axes, rows.items()):
        within = []
        for axis, element in zip(line, ELEMENTS):
            shown = z[..., int(element[0]) - 1, int(element[1]) - 1]
            weights = np.sin(np.radians(2 * theta))
            inside = np.average(np.abs(shown) < 1.96, weights=weights)
            within.append(f"f{element} {100 * inside:.0f} %")
            axis.grid(False)
            mesh = axis.pcolormesh(np.radians(phi), theta, shown, cmap="PuOr", vmin=-6, vmax=6, shading="gouraud")
            axis.set(title=f"$f_{{{element}}}$, {name}\n{inside:.0%} within 1.96 $u$", xticks=[], yticks=[])
            axis.title.set_fontsize(8)
        print(f"{name}: within 1.96 u {', '.join(within)}")
    figure.colorbar(mesh, ax=axes, shrink=0.7, label="difference / $u$")
    picture.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(picture, dpi=100)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(Path(sys.argv[1]), Path(sys.argv[2]))
