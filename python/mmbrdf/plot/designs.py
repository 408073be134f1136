# SPDX-License-Identifier: BSD-3-Clause
"""Expected uncertainties of designs."""
from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import numpy as np

import mmbrdf

from .._arguments import require
from . import labels, sizes
from .colours import series

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MARKERS = "os^Dv<>P"


@sizes.sized
def plan(plan: mmbrdf.Plan, *, axes: Axes | None = None, width_cm: float | None = None) -> tuple[Figure, Axes]:
    """Expected standard uncertainties of ``mmbrdf.plan()``, target by target, a marker for each design. Returns the figure
    and its axes."""
    require("plan", plan, mmbrdf.Plan)
    width = 8.2 if width_cm is None else width_cm * sizes.CM
    names = [
        textwrap.fill(labels.plain(f"{design} ({readings} readings)"), int(width / sizes.em() / 0.66))
        for design, readings in zip(plan.designs, plan.readings)
    ]
    if axes is None:
        lines = sum(name.count("\n") + 1 for name in names)
        height = (8 + 2.0 * len(plan.targets) + 1.3 * lines) * sizes.em()
        axes = labels.Picture(figsize=(width, height), layout="constrained").add_subplot()
    rows, strokes = np.arange(len(plan.targets)), series(len(plan.designs))
    for number, (name, u) in enumerate(zip(names, plan.u)):
        axes.plot(
            u,
            rows,
            _MARKERS[number % len(_MARKERS)],
            label=name,
            fillstyle="none",
            color=strokes[number].color,
        )
    axes.set(xscale="log", xlabel="expected standard uncertainty; f11 and f in sr$^{-1}$")
    axes.set_yticks(rows, [target.replace("_", ",") if target[0].isdigit() else target for target in plan.targets])
    axes.invert_yaxis()
    axes.grid(axis="x", which="both", color="0.9", linewidth=0.6)
    sizes.legend_below(axes, axes.get_legend_handles_labels()[0], columns=1)
    return axes.figure, axes
