# SPDX-License-Identifier: BSD-3-Clause
"""How well an instrument explains the references that it was calibrated with."""
from __future__ import annotations

import csv
import os
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import mmbrdf

from .._arguments import require
from . import sizes
from .colours import Stroke, series
from .scalars import ELEMENTS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from mmbrdf import Calibration

KINDS = {"empty": "empty", "polarizer": "polarizer", "wafer": "wafer"}


class Reference(NamedTuple):
    """Readings of one reference as a matrix, and the matrix that is expected, each divided by its element 11."""

    kind: str
    angle_deg: float
    measured: NDArray[np.float64]
    expected: NDArray[np.float64]


@sizes.sized
def calibration(
    instrument: Calibration,
    references: str | os.PathLike[str],
    *,
    film: tuple[complex, float, complex] | None = None,
    dial_sense: int = 1,
    figure: Figure | None = None,
    width_cm: float | None = None,
) -> tuple[Figure, NDArray]:
    """Readings of references against what is expected of them, as matrices divided by element 11: measured - expected.

    Above by element, a point for each reference and a bar for the root mean square of each kind; below the root mean square
    over the fifteen elements by reference, against its angle. ``references`` is the file that ``calibrate`` read, with the same
    ``film``, of which the thickness that was found counts, and ``dial_sense``. Wafers are left out without a film, and so are
    retarders, whose retardance nobody stated. All points together have the figure of merit, but for what a wafer is besides
    its film. Returns the figure and its two axes. ValueError for a file without such references, OSError for one that cannot
    be read.
    """
    require("instrument", instrument, mmbrdf.Calibration)
    found = list(_references(instrument, references, film, dial_sense))
    if not found:
        raise ValueError(f"{os.fspath(references)}: no references whose matrix is known")
    figure = sizes.figure(width_cm, 6.4, 6.6, layout="constrained") if figure is None else figure
    above, below = figure.subplots(2, 1, height_ratios=(3, 2))
    kinds = [kind for kind in KINDS if any(one.kind == kind for one in found)]
    strokes = series(len(kinds), [KINDS[kind] for kind in kinds])
    for number, (kind, stroke) in enumerate(zip(kinds, strokes)):
        shift = 0.22 * (number - (len(kinds) - 1) / 2)
        _draw_kind(above, below, [one for one in found if one.kind == kind], stroke, shift)
    above.axhline(0, color="0.4", linewidth=0.5, zorder=0)
    above.set(xlim=(-0.6, 14.6), ylabel="measured $-$ expected", xlabel="element, divided by 11")
    above.set_xticks(range(15), ELEMENTS[1:])
    above.set_title(f"{instrument.wavelength_nm:g} nm, figure of merit {instrument.figure_of_merit:.2g}")
    below.set(ylim=(0, None), xlabel="dial of the polarizer, angle of incidence / °", ylabel="root mean\nsquare")
    for axes in (above, below):
        axes.grid(axis="y", color="0.92", linewidth=0.5)
        axes.set_axisbelow(True)
    words = "points: references; bars: root mean square, to both sides"
    sizes.legend_below(below, below.get_legend_handles_labels()[0], words, columns=3)
    return figure, np.array([above, below])


def _draw_kind(above: Axes, below: Axes, some: list[Reference], stroke: Stroke, shift: float) -> None:
    off = np.array([(one.measured - one.expected).ravel()[1:] for one in some])
    places = np.arange(15) + shift
    style = dict(
        marker=stroke.marker, color=stroke.color, linestyle="none", markeredgewidth=0.5, markerfacecolor="none"
    )
    above.plot(np.tile(places, len(off)), off.ravel(), markersize=2.2, alpha=0.7, **style)
    rms = np.sqrt((off**2).mean(axis=0))
    above.vlines(places, -rms, rms, color=stroke.color, linewidth=2.0, zorder=3)
    angles = [one.angle_deg for one in some]
    below.plot(angles, np.sqrt((off**2).mean(axis=1)), markersize=4.0, label=stroke.label, **style)


def _references(instrument, path, film, dial_sense: int) -> Iterator[Reference]:
    """Those whose matrix is known."""
    for kind, angle_deg, readings in _measured(path, instrument.polarimeter):
        if kind == "empty":
            expected = np.eye(4)
        elif kind == "polarizer":
            azimuth = instrument.polarizer_offset_deg + dial_sense * angle_deg
            expected = mmbrdf.polarizer(azimuth, instrument.extinction)
        elif kind == "wafer" and film is not None:
            layer = film[0], instrument.film_thickness_um, film[2]
            expected = mmbrdf.film_reflection(layer, instrument.wavelength_nm, angle_deg)
        else:
            continue
        measured = instrument.polarimeter.reduce(readings)
        yield Reference(kind, angle_deg, measured / measured[0, 0], expected / expected[0, 0])


def _measured(path, polarimeter) -> Iterator[tuple[str, float, NDArray[np.float64]]]:
    """Kind, angle and readings of each measurement of a file."""
    groups: dict[str, tuple[str, float, dict[tuple[int, int], float]]] = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            try:
                value = float(row["intensity"]) - float(row.get("dark") or 0)
                scale = float(row.get("monitor") or 1) * float(row.get("gain") or 1)
                if not scale > 0:
                    raise ValueError(
                        f"monitor and gain must be positive, not {row.get('monitor')} and {row.get('gain')}"
                    )
                value /= scale
                start = row["reference"], float(row["angle_deg"] or 0), {}
                _, _, readings = groups.setdefault(row["number"], start)
                readings[int(row["generator_state"]) - 1, int(row["analyzer_state"]) - 1] = value
            except (KeyError, TypeError, ValueError) as error:
                raise ValueError(f"{os.fspath(path)}: not readings of references: {error}") from None
    if polarimeter.pairs is None:
        shape = len(polarimeter.analyzer), len(polarimeter.generator)
        pairs = [(generator, analyzer) for analyzer in range(shape[0]) for generator in range(shape[1])]
    else:
        shape, pairs = (len(polarimeter.pairs),), [tuple(pair) for pair in polarimeter.pairs]
    for kind, angle_deg, readings in groups.values():
        try:
            yield kind, angle_deg, np.array([readings[pair] for pair in pairs]).reshape(shape)
        except KeyError:
            raise ValueError(f"{os.fspath(path)}: other states than those of the instrument") from None
