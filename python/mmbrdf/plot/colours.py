# SPDX-License-Identifier: BSD-3-Clause
"""Colours, line styles and markers that are told apart without red and green, and in grey prints.

Whatever stands for different things in one picture differs in lightness, and in style or marker besides.
"""
from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Colormap, to_hex


class Stroke(NamedTuple):
    """How one of several lines is drawn. ``style`` and ``marker`` are matplotlib's."""

    color: str
    label: str
    style: str | tuple = "-"
    marker: str = "o"


STYLES: tuple[str | tuple, ...] = (
    "-",
    (0, (5, 1.6)),
    (0, (1, 1.2)),
    (0, (6, 1.5, 1, 1.5)),
    (0, (5, 1.5, 1, 1.5, 1, 1.5)),
)
MARKERS = "osD^vP"

COMPONENTS = {
    "ss": Stroke("#000000", r"s $\rightarrow$ s", STYLES[0], "o"),
    "sp": Stroke("#c14a09", r"s $\rightarrow$ p", STYLES[1], "s"),
    "ps": Stroke("#2bad83", r"p $\rightarrow$ s", STYLES[2], "D"),
    "pp": Stroke("#12408c", r"p $\rightarrow$ p", STYLES[3], "^"),
}
"""Of each pair of linear polarizations, the incident one first: black, red, green and blue as in Germer (2017), of lightness
0, 47, 64 and 28 so that they stay apart in grey."""

UNPOLARIZED = {"f11": Stroke("#000000", r"$f_{\mathrm{r},11}$")}
"""Of unpolarized light alone."""

UNMEASURED = "#ededed"
"""Ground of what was not measured or has no meaning; it is hatched, too, since grey scales come near it."""

HATCH, HATCH_COLOUR = "//////", "0.62"

VALUES = "viridis"
"""Of numbers from small to large: from dark to light."""

SIGNED = "cividis"
"""Of numbers of both signs: blue and dark below zero, grey at zero, yellow and light above. Nunez, Anderton and Renslow, PLoS ONE
13, e0199239 (2018)."""


def series(count: int, labels: list[str] | None = None) -> list[Stroke]:
    """Strokes of ``count`` things in order: from dark to light, with styles and markers that change from one to the next."""
    places = np.linspace(0.0, 0.78, count) if count > 1 else np.zeros(1)
    names = labels or [""] * count
    return [
        Stroke(to_hex(colormaps["cividis"](place)), name, STYLES[n % len(STYLES)], MARKERS[n % len(MARKERS)])
        for n, (place, name) in enumerate(zip(places, names))
    ]


def with_fault_colour(colour: str) -> Colormap:
    """VALUES with another colour below its lower end."""
    return colormaps[VALUES].with_extremes(under=colour)
