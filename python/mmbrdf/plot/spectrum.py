# SPDX-License-Identifier: BSD-3-Clause
"""The coefficients of a model."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib import rcParams
from matplotlib.lines import Line2D

import mmbrdf

from .._arguments import require
from . import labels, sizes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mmbrdf import Model


@sizes.sized
def coefficient_spectrum(
    model: Model,
    *,
    power: int = 0,
    coverage: float = 1.0,
    axes: Axes | None = None,
    width_cm: float | None = None,
) -> tuple[Figure, Axes]:
    """Moduli of the coefficients of one power of the wavelength, block after block in the model's order of modes.

    Error bars are ``coverage`` standard uncertainties of the fit; a marker is empty if zero lies within twice the
    standard uncertainty, and points down if the coefficient is negative. Those of block 11 are in sr^-1, the others
    without unit, each times micrometres to the power -``power``. Returns the figure and its axes.
    """
    require("model", model, mmbrdf.Model)
    if not 0 <= power <= model.powers:
        raise ValueError(f"power = {power}, the model has powers 0 to {model.powers}")
    if axes is None:
        axes = sizes.figure(width_cm, 8.2, 5.4, layout="constrained").add_subplot()
    first, ticks = 0, []
    for number, block in enumerate(model.blocks):
        values = np.atleast_2d(block.coefficients)[power]
        at = first + np.arange(len(values))
        _draw_block(axes, at, values, _uncertainties(block, power, len(values)), coverage, "0.15")
        ticks.append((at.mean(), "\n".join(block.elements)))
        first += len(values) + 2
        if number + 1 < len(model.blocks):
            axes.axvline(first - 1.5, color="0.85", linewidth=0.8, zorder=0)
    unit = f"11 in sr$^{{-1}}$ {_micrometres(power)}".rstrip() + (f", others in {_micrometres(power)}" if power else "")
    axes.set(yscale="log", xlim=(-2, first - 1), xlabel=f"modes, by elements that were fitted together\n{unit}")
    axes.set_ylabel("modulus of coefficient")
    axes.set_xticks(*zip(*ticks))
    axes.set_title(
        (f"{labels.plain(model.name)}: " if model.name else "")
        + f"{model.family}, "
        + (f"$\\lambda^{power}$" if model.powers else "one wavelength"),
        loc="left",
    )
    _legend(axes)
    return axes.figure, axes


def _uncertainties(block, power: int, modes: int):
    """Standard uncertainties of one power's coefficients, or None if they are not known."""
    if block.covariance is None:
        return None
    return np.sqrt(np.diag(block.covariance))[power * modes : (power + 1) * modes]


def _draw_block(axes, at, values, uncertainties, coverage: float, color) -> None:
    moduli = np.abs(values)
    empty = np.zeros(len(values), bool)
    if uncertainties is not None:
        empty = moduli < 2 * uncertainties
        bars = coverage * uncertainties
        # A logarithmic axis has no place for bars that reach zero: they end low instead.
        axes.errorbar(
            at,
            moduli,
            yerr=(np.minimum(bars, 0.9 * moduli), bars),
            fmt="none",
            ecolor=color,
            alpha=0.6,
            elinewidth=0.9,
            zorder=1,
        )
    for negative in (False, True):
        chosen = (values < 0) == negative
        faces = [color if not hollow else "white" for hollow in empty[chosen]]
        axes.scatter(
            at[chosen],
            moduli[chosen],
            s=(0.36 * float(rcParams["font.size"])) ** 2,
            marker="v" if negative else "^",
            facecolors=faces,
            edgecolors=[color],
            linewidths=0.8,
            zorder=2,
        )


def _micrometres(power: int) -> str:
    """The unit that a coefficient has of its power of the wavelength."""
    return f"µm$^{{-{power}}}$" if power else ""


def _legend(axes) -> None:
    style = dict(linestyle="none", color="0.15", markersize=4.5)
    handles = [
        Line2D([], [], marker="^", label="positive", **style),
        Line2D([], [], marker="v", label="negative", **style),
        Line2D([], [], marker="^", markerfacecolor="white", label="within $2u$ of zero", **style),
    ]
    sizes.legend_below(axes, handles, ems=7.6, columns=3)
