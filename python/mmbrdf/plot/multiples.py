# SPDX-License-Identifier: BSD-3-Clause
"""Small multiples: the same pictures of a model, or of what it leaves of samples, for several wavelengths side by side."""
from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib import rcParams
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.lines import Line2D
from matplotlib.ticker import MultipleLocator

import mmbrdf

from .._arguments import number, own_wavelength, require
from . import disc, labels, sizes
from .curves import component_handles, grey_beyond, in_plane_curves
from .maps import Scale, Shown, chosen_scale, shown
from .samples import COUNTS
from .scalars import scalar

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from mmbrdf import Dataset, Model


class _Row(NamedTuple):
    """Maps of one quantity, and the scale that they share."""

    maps: list[Shown]
    scale: Scale


@sizes.sized
def by_wavelength(
    model: Model,
    wavelength_nm: float | Sequence[float] | None = None,
    theta_i_deg: float = 45.0,
    *,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    samples: int = 121,
    coverage: float = 2.0,
    width_cm: float | None = None,
) -> tuple[Figure, NDArray]:
    """A column for each of the wavelengths (nm), those of the fit without any: f11 and the depolarization parameter over the
    hemisphere of detection, each with one scale for all columns, and below them the BRDF between linear polarizations in the
    plane of incidence, with bands of ``coverage`` standard uncertainties if the model has a covariance.

    What needs elements that were not measured is left out. Marks are those of ``map``. Angles in degrees. Returns the figure and
    its axes, (rows, wavelengths). ValueError for a model that does not know its wavelengths, unless they are given.
    """
    require("model", model, mmbrdf.Model)
    theta_i_deg = number("theta_i_deg", theta_i_deg)
    wavelengths = _wavelengths("model", model.wavelengths_nm, wavelength_nm, model)
    view = disc.View(theta_i_deg, phi_i_deg, model.theta_r_max_deg)
    quantities = ["11"] if model.not_measured else ["11", "depolarization"]
    rows = [_maps(model, quantity, wavelengths, view, samples) for quantity in quantities]
    curves = not {"12", "21", "22"} & set(model.not_measured)
    figure, axes = _grid(len(rows), len(wavelengths), curves, width_cm)
    for row, row_axes in zip(rows, axes):
        _draw_maps(figure, row, row_axes, view)
    if curves:
        _draw_curves(model, wavelengths, theta_i_deg, phi_i_deg, axes[-1], coverage, _is_narrow(width_cm))
    for nm, top in zip(wavelengths, axes[0]):
        top.set_title(labels.title("", nm, source=model))
    name = labels.title(labels.plain(model.name), None, theta_i_deg)
    figure.suptitle(name, y=1 - 0.4 * sizes.em() / (figure.bbox.height / figure.dpi), va="top")
    return figure, axes


def _wavelengths(name: str, own: Sequence[float], chosen: Any, source: Any) -> list[float | None]:
    if chosen is None:
        if len(own) == 0:
            return [own_wavelength(source, None)]
        return [float(nm) for nm in own]
    return [own_wavelength(source, each) for each in np.atleast_1d(chosen)]


def _maps(model, quantity: str, wavelengths, view: disc.View, samples: int) -> _Row:
    asked = scalar(quantity, None, None)
    maps = [shown(asked, model, None, "value", nm, view, None, samples) for nm in wavelengths]
    values = np.stack([one.image.values for one in maps])
    fitted = np.stack([one.image.within(view.theta_max_deg) for one in maps])
    return _Row(maps, chosen_scale(values, fitted, measured=False))


def _is_narrow(width_cm: float | None) -> bool:
    """One column of a journal: a line of it is too short for all that a legend says."""
    return width_cm is not None and width_cm < 12


_LEFT, _RIGHT, _TOP, _BOTTOM, _GAP = 6.0, 7.2, 3.6, 5.6, 0.8
"""Of the grid, in ems: room for words and scales around it, and between its cells."""


def _grid(maps: int, columns: int, curves: bool, width_cm: float | None) -> tuple[Figure, NDArray]:
    """Square discs, and lower panels for curves."""
    em = sizes.em()
    width = 2.0 * columns + 1.6 if width_cm is None else width_cm * sizes.CM
    left, right, gap = _LEFT * em, _RIGHT * em, _GAP * em
    side = min((width - left - right - (columns - 1) * gap) / columns, 2.6)
    heights = [side] * maps + ([0.85 * side + 1.2 * em] if curves else [])
    bottom = (_BOTTOM + 1.4 * _is_narrow(width_cm)) if curves else 3.6
    height = sum(heights) + (len(heights) - 1) * gap + (_TOP + bottom) * em
    figure = labels.Picture(figsize=(width, height))
    axes = np.empty((len(heights), columns), object)
    top = height - _TOP * em
    for row, tall in enumerate(heights):
        for column in range(columns):
            place = left + column * (side + gap), top - tall, side, tall if row < maps else tall - 1.2 * em
            axes[row, column] = figure.add_axes(
                (place[0] / width, place[1] / height, place[2] / width, place[3] / height),
            )
        top -= tall + gap
    return figure, axes


def _draw_maps(figure, row: _Row, axes, view: disc.View) -> None:
    for one, each in zip(row.maps, axes):
        disc.draw(each, one.image, row.scale.cmap, row.scale.norm)
        disc.mark(each, view, size=3.4)
    last, em = axes[-1].get_position(), sizes.em()
    width = figure.bbox.width / figure.dpi
    place = (last.x1 + 0.8 * em / width, last.y0 + 0.08 * last.height, 0.8 * em / width, 0.84 * last.height)
    bar = figure.colorbar(
        ScalarMappable(row.scale.norm, row.scale.cmap), cax=figure.add_axes(place), extend=row.scale.extend
    )
    name = row.maps[0].label.replace(" depolarization", "\ndepolarization")
    is_longer = last.height * figure.bbox.height / figure.dpi < 0.5 * em * len(name.splitlines()[-1])
    bar.set_label(name, loc="top" if is_longer else "center")  # and goes on below, beside the curves


def _draw_curves(model, wavelengths, theta_i_deg: float, phi_i_deg: float, axes, coverage: float, narrow: bool) -> None:
    limit = 90.0 if model.theta_r_max_deg is None else model.theta_r_max_deg
    ends: list[float] = []
    for nm, each in zip(wavelengths, axes):
        in_plane_curves(
            model, nm, theta_i_deg, phi_i_deg=phi_i_deg, coverage=coverage, linewidth=1.1, axes=each, legend=False
        )
        for line in each.lines:
            inside = np.abs(line.get_xdata()) <= limit
            ends += [float(np.min(line.get_ydata()[inside])), float(np.max(line.get_ydata()[inside]))]
        grey_beyond(each, model.theta_r_max_deg, 90.0)
        each.set(xlim=(-90, 90), xticks=[-60, 0, 60], xlabel=r"$\theta_\mathrm{r}$ / °")
        each.grid(color="0.92", linewidth=0.5)
        each.set_axisbelow(True)
    margin = 0.08 * (max(ends) - min(ends))
    for each in axes:
        each.set_ylim(min(ends) - margin, max(ends) + margin)
        if each is not axes[0]:
            each.set_yticklabels([])
            each.set_ylabel("")
    axes[0].set_ylabel(r"$f_\mathrm{r}$ / sr$^{-1}$")
    figure = axes[0].figure
    height = figure.bbox.height / figure.dpi
    bands = f"bands: $k$ = {coverage:g}" if model.has_covariance else None
    middle = (axes[0].get_position().x0 + axes[-1].get_position().x1) / 2
    handles = component_handles(1.1)
    if bands:
        handles.append(Line2D([], [], linestyle="none", label=bands))
    figure.legend(
        handles=handles,
        ncol=3 if narrow else 5,
        loc="lower center",
        bbox_to_anchor=(0.5 if narrow else middle, 0.3 * sizes.em() / height),
        frameon=False,
        borderpad=0,
    )


@sizes.sized
def residuals(
    model: Model,
    data: Dataset,
    wavelength_nm: float | Sequence[float] | None = None,
    *,
    width_cm: float | None = None,
) -> tuple[Figure, NDArray]:
    """Measured minus model at samples of any directions, a column for each of the wavelengths (nm), those of the samples without
    any: f11 in percent of the model's, and the root mean square over the other measured elements of what is left of them.

    ``theta_r`` is positive where the detector is on the forward side of the source, and the colour is theta_i; dashed lines are
    the root mean square of all samples, in the upper row to both sides of 0. Returns the figure and its axes, (1 or 2,
    wavelengths). ValueError if there are no samples at a wavelength.
    """
    require("model", model, mmbrdf.Model)
    require("data", data, mmbrdf.Dataset)
    wavelengths = _wavelengths("data", data.wavelengths_nm, wavelength_nm, data)
    found = [_left(model, data, nm) for nm in wavelengths]
    rows = 1 if all(np.isnan(others).all() for _, _, others in found) else 2
    columns = len(wavelengths)
    tall = 0.8 + 1.3 * rows
    if _is_narrow(width_cm):
        tall *= 1.5  # in which the words beside it have room
    figure = sizes.figure(width_cm, 7.2, tall, layout="constrained")
    axes = figure.subplots(rows, columns, sharex=True, sharey="row", squeeze=False)
    points = None
    for (here, f11, others), nm, pair in zip(found, wavelengths, axes.T):
        for values, each in zip((f11, others), pair):
            points = _scatter(each, here, values, both_sides=values is f11)
        pair[0].set_title(labels.title("", nm))
    figure.supxlabel(r"$\theta_\mathrm{r}$, forward positive / °", fontsize=rcParams["axes.labelsize"])
    axes[0, 0].set_ylabel("residual of\n$f_{\\mathrm{r},11}$ / %")
    if rows == 2:
        axes[1, 0].set_ylabel("rms residual of\nother $m_{ij}$")
        axes[1, 0].set_ylim(0, None)
    figure.colorbar(points, ax=axes, label=r"$\theta_\mathrm{i}$ / °", ticks=[0, 30, 60, 90], aspect=30, pad=0.01)
    return figure, axes


def _left(model, data, nm: float | None) -> tuple[Dataset, NDArray, NDArray]:
    """The samples of a wavelength, and of each what is left of f11, relative, and of the others, their root mean square."""
    here = data[np.isclose(data.wavelength_nm, nm, rtol=1e-6)]
    if len(here) == 0:
        raise ValueError(f"no samples at {nm:g} nm")
    measured, predicted = here.mueller, disc.evaluate(model, nm, here.geometry)
    with np.errstate(divide="ignore", invalid="ignore"):
        f11 = 100 * (measured[:, 0, 0] / predicted[:, 0, 0] - 1)
    others = (disc.normalized(measured) - disc.normalized(predicted)).reshape(-1, 16)[:, 1:]
    known = np.isfinite(others)
    squares = np.where(known, others, 0.0) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        rms = np.sqrt(squares.sum(axis=1) / known.sum(axis=1))
    return here, np.where(predicted[:, 0, 0] > 0, f11, np.nan), np.where(measured[:, 0, 0] > 0, rms, np.nan)


def _scatter(axes: Axes, here: Dataset, values: NDArray, *, both_sides: bool) -> Any:
    forward = np.cos(np.radians(here.phi_r_deg - here.phi_i_deg)) <= 1e-6
    angle = np.where(forward, 1, -1) * here.theta_r_deg
    known = np.isfinite(values)
    size = 5 if len(here) < 600 else 2.5
    points = axes.scatter(
        angle[known],
        values[known],
        size,
        here.theta_i_deg[known],
        cmap=COUNTS,
        norm=Normalize(0, 90),
        rasterized=len(here) > 2000,
    )
    points.set(edgecolor="0.3", linewidth=0.15)
    if known.any():
        rms = float(np.sqrt(np.mean(values[known] ** 2)))
        for place in (-rms, rms) if both_sides else (rms,):
            axes.axhline(place, color="0.2", linewidth=0.7, linestyle=(0, (5, 3)), zorder=3)
    if both_sides:
        axes.axhline(0, color="0.2", linewidth=0.5, zorder=1)
    axes.set(xlim=(-90, 90))
    axes.xaxis.set_major_locator(MultipleLocator(30 if axes.get_subplotspec().get_gridspec().ncols < 3 else 60))
    axes.grid(color="0.92", linewidth=0.5)
    axes.set_axisbelow(True)
    return points
