# SPDX-License-Identifier: BSD-3-Clause
"""Expected uncertainties of designs."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import mmbrdf

from .._arguments import require
from . import labels

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MARKERS = "os^Dv<>P"


def plan(plan: mmbrdf.Plan, *, axes: Axes | None = None) -> tuple[Figure, Axes]:
    """Expected standard uncertainties of ``mmbrdf.plan()``, target by target, a marker for each design. Returns the figure
    and its axes."""
    require("plan", plan, mmbrdf.Plan)
    if axes is None:
        height = 2.2 + 0.25 * len(plan.targets) + 0.2 * len(plan.designs)
        axes = labels.Picture(figsize=(8.2, height), layout="constrained").add_subplot()
    rows = np.arange(len(plan.targets))
    for number, (design, readings, u) in enumerate(zip(plan.designs, plan.readings, plan.u)):
        axes.plot(
            u,
            rows,
            _MARKERS[number % len(_MARKERS)],
            label=f"{labels.plain(design)} ({readings} readings)",
            fillstyle="none",
        )
    axes.set(xscale="log", xlabel="expected standard uncertainty; f11 and f in sr$^{-1}$")
    axes.set_yticks(rows, [target.replace("_", ",") if target[0].isdigit() else target for target in plan.targets])
    axes.invert_yaxis()
    axes.grid(axis="x", which="both", color="0.9", linewidth=0.6)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12 - 0.5 / len(rows)), fontsize=8, frameon=False)
    return axes.figure, axes
