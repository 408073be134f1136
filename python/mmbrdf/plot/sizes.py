# SPDX-License-Identifier: BSD-3-Clause
"""Sizes of figures: as they suit a screen, or the column of a journal that ``width_cm`` says."""
from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, TypeVar

from matplotlib import rc_context, rcParams
from matplotlib.transforms import offset_copy

from .._arguments import number
from . import labels

CM = 1 / 2.54
"""In inches."""

Draw = TypeVar("Draw", bound=Callable[..., Any])


def _settings(width_cm: float) -> dict[str, Any]:
    """Of matplotlib, for a figure of this width: 7 points in a narrow column, 8 in a wide one, and nothing below 6."""
    points = 7.0 if width_cm < 12 else 8.0
    return {
        "font.size": points,
        "axes.titlesize": points,
        "axes.labelsize": points,
        "figure.titlesize": points,
        "xtick.labelsize": points - 0.5,
        "ytick.labelsize": points - 0.5,
        "legend.fontsize": points - 0.5,
        "axes.linewidth": 0.6,
        "xtick.major.width": 0.6,
        "ytick.major.width": 0.6,
        "xtick.major.size": 2.5,
        "ytick.major.size": 2.5,
        "xtick.major.pad": 2.0,
        "ytick.major.pad": 2.0,
        "axes.labelpad": 2.0,
        "axes.titlepad": 4.0,
        "legend.handlelength": 2.6,
        "legend.columnspacing": 1.0,
        "legend.handletextpad": 0.5,
    }


_SCREEN = {"legend.handlelength": 2.6, "legend.fontsize": "small", "axes.titlesize": "medium"}


def sized(draw: Draw) -> Draw:
    """What a function that takes ``width_cm`` draws has the fonts and lines of such a figure."""

    @functools.wraps(draw)
    def drawn(*arguments: Any, **options: Any) -> Any:
        width_cm = options.get("width_cm")
        if not number("coverage", options.get("coverage", 1.0)) > 0:
            raise ValueError(f"coverage = {options['coverage']}, must be positive")
        if width_cm is None:
            with rc_context(_SCREEN):
                return draw(*arguments, **options)
        if not number("width_cm", width_cm) > 0:
            raise ValueError(f"width_cm = {width_cm}, must be positive")
        with rc_context(_settings(width_cm)):
            result = draw(*arguments, **options)
            _keep_ticks(result[0])
        return result

    return drawn  # type: ignore[return-value]


def _keep_ticks(figure: Any) -> None:
    """Ticks are made when they are drawn, with the settings of then: says theirs to each axis."""
    for axes in figure.axes:
        for name, which in (("x", axes.xaxis), ("y", axes.yaxis)):
            if "labelsize" not in which._major_tick_kw:
                axes.tick_params(axis=name, which="both", labelsize=rcParams[f"{name}tick.labelsize"])
            axes.tick_params(axis=name, which="major", width=0.6, length=2.5, pad=2.0)


def figure(width_cm: float | None, width: float, height: float, **options: Any) -> labels.Picture:
    """A figure of width x height inches on a screen, or with that shape and a column's width."""
    if width_cm is not None:
        height, width = height * width_cm * CM / width, width_cm * CM
    return labels.Picture(figsize=(width, height), **options)


def em() -> float:
    """Height of the font, in inches."""
    return float(rcParams["font.size"]) / 72


def legend_below(
    axes: Any, handles: Any, title: str | None = None, *, ems: float = 3.1, columns: int = 2, **style: Any
) -> None:
    """A legend so many font heights below axes: behind the ticks and their label. Within the axes of others, whose figure may
    have no room there."""
    place: dict[str, Any] = dict(ncol=2, loc="best", framealpha=0.8)
    if isinstance(axes.figure, labels.Picture):
        below = offset_copy(axes.transAxes, axes.figure, 0, -ems * em(), units="inches")
        place = dict(loc="upper center", bbox_to_anchor=(0.5, 0), bbox_transform=below, frameon=False, borderpad=0)
        place["ncol"] = columns
    legend = axes.legend(handles=handles, title=title or None, **place, **style)
    legend.get_title().set_fontsize(0.9 * float(rcParams["font.size"]))
