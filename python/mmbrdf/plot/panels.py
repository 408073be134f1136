# SPDX-License-Identifier: BSD-3-Clause
"""All sixteen elements side by side, as in Figs. 1-4 of Germer (2017)."""
from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from matplotlib import rcParams
from matplotlib.cm import ScalarMappable
from matplotlib.patheffects import withStroke

import mmbrdf

from .._arguments import require
from . import disc, labels, sizes
from .maps import Scale, chosen_scale, named, residual_scale
from .scalars import ELEMENTS, measured_in, model_uncertainty, ratio, sample_uncertainty, scalar

if TYPE_CHECKING:
    from matplotlib.figure import Figure, SubFigure
    from numpy.typing import NDArray

    from mmbrdf import Dataset, Model

F11_LABEL = r"$f_{\mathrm{r},11}$ / sr$^{-1}$"
ELEMENT_LABEL = r"$m_{ij} = f_{\mathrm{r},ij}\,/\,f_{\mathrm{r},11}$"
_ELEMENTS_LABEL = "other elements\n$m_{ij} = f_{\\mathrm{r},ij}/f_{\\mathrm{r},11}$"

PAPER_F11, PAPER_OTHERS = (0.25, 0.45), 0.1
"""Limits of Figs. 1-4 of Germer (2017): of f11 in sr^-1, and to both sides of 0."""

_LARGE = {(1, 1), (1, 2), (2, 1), (2, 2), (3, 3)}
"""Rows and columns, from 0, of the elements that a scale has to itself: of most samples others are much smaller."""


class _Bar(NamedTuple):
    """A scale, its label, and which elements have it."""

    scale: Scale
    label: str
    elements: set[tuple[int, int]]


@sizes.sized
def hemisphere(
    source: Model | Dataset,
    wavelength_nm: float | None,
    theta_i_deg: float,
    *,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    frame: str = "xy",
    samples: int = 201,
    scale: str = "data",
    f11_limits: tuple[float, float] | None = None,
    limit: float | None = None,
    title: str | None = None,
    figure: Figure | SubFigure | None = None,
    decorated: bool = True,
    width_cm: float | None = None,
) -> tuple[Figure | SubFigure, NDArray]:
    """The Mueller-matrix BRDF over the hemisphere at one direction of incidence, in a ``frame`` that the picture says.

    ``source`` is a model, evaluated at ``samples`` x ``samples`` places, or a data set, each of whose samples at this
    wavelength (nm) and direction of incidence (degrees) is a cell. Element 11 is in sr^-1, the others are divided by it.
    With ``scale="data"`` there are three scales with the limits of what is shown, as those of ``map``: of 11; of 22, 23, 32, 33
    and 44; of the others. "paper" is that of Germer (2017): 11 from black at 0.25 to white at 0.45, the others from
    blue at -0.1 over white to red at 0.1. ``f11_limits``, and ``limit`` to both sides of 0, are limits of your own.
    What lies beyond has the colour of the end. Marks are those of ``map``. Without a ``title`` it names
    the model, or says that it was measured.

    Returns the figure and its axes, 4 x 4. With ``decorated=False`` there are only the discs, for use in a
    ``figure`` or subfigure with many of them. ValueError if a data set has no such samples.
    """
    wavelength_nm, theta_i_deg = disc.question(source, wavelength_nm, theta_i_deg)
    if scale not in ("data", "paper"):
        raise ValueError(f"scale = {scale!r}, expected data or paper")
    _require_positive(limit=limit)
    image = disc.matrices(source, wavelength_nm, theta_i_deg, phi_i_deg, frame, samples)
    image = image._replace(values=disc.normalized(image.values))
    view = disc.View(theta_i_deg, phi_i_deg, getattr(source, "theta_r_max_deg", None))
    if scale == "paper":
        f11_limits = PAPER_F11 if f11_limits is None else f11_limits
        limit = PAPER_OTHERS if limit is None else limit
    bars = _bars(image, view, isinstance(source, mmbrdf.Dataset), f11_limits, limit, scale == "paper")
    title = labels.title(named(source), wavelength_nm, theta_i_deg, frame, source) if title is None else title
    return _sixteen(image, view, bars, title, figure, decorated, width_cm)


def _require_positive(**limits: float | None) -> None:
    for name, value in limits.items():
        if value is not None and not value > 0:
            raise ValueError(f"{name} = {value}: expected a positive number, for both sides of 0")


def _bars(image: disc.DiscImage, view: disc.View, measured: bool, f11_limits, limit, paper: bool) -> list[_Bar]:
    """The scales of a hemisphere: two if the limits of the other elements are given, else three."""
    fitted = image.within(view.theta_max_deg)
    ends = None if limit is None else (-limit, limit)

    def scale(elements, given, cmap, signed):
        values = np.stack([image.values[..., row, column] for row, column in elements], axis=-1)
        where = np.broadcast_to(fitted[..., None], values.shape)
        return chosen_scale(values, where, measured=measured, limits=given, cmap=cmap, signed=signed)

    others = {(row, column) for row, column in np.ndindex(4, 4)} - {(0, 0)}
    f11 = _Bar(scale([(0, 0)], f11_limits, "gray", False), F11_LABEL, {(0, 0)})
    cmap = "RdBu_r" if paper else None
    if ends is not None:
        return [f11, _Bar(scale(sorted(others), ends, cmap, True), _ELEMENTS_LABEL, others)]
    small = others - _LARGE
    names = "$m_{ij}$ of 22, 23,\n32, 33, 44", "other $m_{ij}$"
    return [f11] + [
        _Bar(scale(sorted(these), None, cmap, True), name, these) for name, these in zip(names, (_LARGE, small))
    ]


@sizes.sized
def residual_map(
    model: Model,
    data: Dataset,
    wavelength_nm: float | None,
    theta_i_deg: float,
    *,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    frame: str = "xy",
    over_u: bool = False,
    f11_limit: float | None = None,
    limit: float | None = None,
    title: str | None = None,
    figure: Figure | SubFigure | None = None,
    decorated: bool = True,
    width_cm: float | None = None,
) -> tuple[Figure | SubFigure, NDArray]:
    """Measured minus model at the samples of one wavelength (nm) and direction of incidence (degrees).

    Element 11 in sr^-1, the others divided by f11, over three times the root mean square to both sides of 0, or over
    ``f11_limit`` and ``limit``. With ``over_u`` each is divided by its standard uncertainty, that of the sample and of the
    model together, over -3 ... 3. Marks and frame as those of ``hemisphere``.
    Returns the figure and its axes, 4 x 4. ValueError if the data set has no such samples, or one side has no uncertainties.
    """
    require("model", model, mmbrdf.Model)
    require("data", data, mmbrdf.Dataset)
    _require_positive(f11_limit=f11_limit, limit=limit)
    wavelength_nm, theta_i_deg = disc.question(data, wavelength_nm, theta_i_deg)
    chosen = disc.samples_at(data, wavelength_nm, theta_i_deg, phi_i_deg)
    measured = measured_in(chosen, frame)
    predicted = disc.evaluate(model, wavelength_nm, chosen.geometry, frame)
    values = disc.normalized(measured) - disc.normalized(predicted)
    if over_u:
        values = ratio(values, _uncertainties(model, chosen, wavelength_nm, frame))
    image = disc.sample_cells(chosen, values)
    view = disc.View(theta_i_deg, phi_i_deg, model.theta_r_max_deg)
    bars = _residual_bars(values, over_u, f11_limit, limit)
    title = labels.title(named(data, model), wavelength_nm, theta_i_deg, frame, model) if title is None else title
    return _sixteen(image, view, bars, title, figure, decorated, width_cm)


def _uncertainties(model: Model, data: Dataset, wavelength_nm, frame: str) -> NDArray[np.float64]:
    """(samples, 4, 4) of f11, and of the other elements divided by it: of model and samples together."""
    variance = np.zeros((len(data), 4, 4))
    for name in ELEMENTS:
        asked, element = scalar(name, frame), variance[:, int(name[0]) - 1, int(name[1]) - 1]
        element += sample_uncertainty(asked, data) ** 2
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", mmbrdf.ExtrapolationWarning)
            element += model_uncertainty(asked, model, wavelength_nm, data.geometry) ** 2
    return np.sqrt(variance)


def _residual_bars(values: NDArray[np.float64], over_u: bool, f11_limit, limit) -> list[_Bar]:
    others = {(row, column) for row, column in np.ndindex(4, 4)} - {(0, 0)}
    if over_u:
        end = 3.0 if limit is None else limit
        scale = chosen_scale(values, np.isfinite(values), measured=True, limits=(-end, end), signed=True)
        return [_Bar(scale, "residual / u", others | {(0, 0)})]
    names = "residual of\n$f_{\\mathrm{r},11}$ / sr$^{-1}$", "residual\nof $m_{ij}$"
    found = []
    for name, these, given in zip(names, ({(0, 0)}, others), (f11_limit, limit)):
        some = np.stack([values[..., row, column] for row, column in sorted(these)], axis=-1)
        scale = residual_scale(some, False)
        if given is not None:
            scale = chosen_scale(some, np.isfinite(some), measured=True, limits=(-given, given), signed=True)
        found.append(_Bar(scale, name, these))
    return found


def _sixteen(image: disc.DiscImage, view: disc.View, bars: list[_Bar], title: str, figure, decorated: bool, width_cm):
    """4 x 4 discs of values (rows, columns, 4, 4)."""
    if figure is None:
        figure = _own_figure(width_cm, decorated)
    width, height = figure.bbox.width / figure.dpi, figure.bbox.height / figure.dpi
    space = dict(left=0.025, right=0.975, bottom=0.025, top=0.975)
    if decorated:
        left, right, bottom, top = (edge * sizes.em() for edge in _EDGES)
        space = dict(left=left / width, right=1 - right / width, bottom=bottom / height, top=1 - top / height)
    axes = figure.subplots(4, 4, gridspec_kw=dict(wspace=0.04, hspace=0.04, **space))
    for row, column in np.ndindex(4, 4):
        scale = next(bar.scale for bar in bars if (row, column) in bar.elements)
        one = image._replace(values=image.values[..., row, column])
        disc.draw(axes[row, column], one, scale.cmap, scale.norm)
        if decorated:
            disc.mark(axes[row, column], view, size=2.2 + 0.35 * width)
            name = dict(ha="left", va="top", path_effects=[withStroke(linewidth=1.6, foreground="white")])
            axes[row, column].text(-0.98, 1.07, f"{row + 1}{column + 1}", fontsize=_small(), **name)
    if decorated:
        _write_coordinates(figure, axes, title, width, height)
        _draw_bars(figure, axes, bars, width, height)
        _write_key(figure, axes, view, disc.lacks(image), bars, height)
    return figure, axes


_EDGES = 3.6, 8.6, 6.0, 2.0
"""Left, right, bottom and top of the discs, in ems: room for coordinates, scales, the key and the title."""


def _small() -> float:
    return max(6.0, 0.85 * float(rcParams["font.size"]))


def _own_figure(width_cm: float | None, decorated: bool) -> labels.Picture:
    """Of a height that makes the discs touch."""
    if not decorated:
        return sizes.figure(width_cm, 4, 4)
    width = 6.6 if width_cm is None else width_cm * sizes.CM
    left, right, bottom, top = (edge * sizes.em() for edge in _EDGES)
    return sizes.figure(width_cm, width, width - left - right + bottom + top)


def _write_coordinates(figure, axes, title: str, width: float, height: float) -> None:
    """The coordinates of the corner disc, and a title."""
    axes[3, 0].set(xticks=[-1, 0, 1], yticks=[-1, 0])  # at 1 is the element's name
    axes[3, 0].tick_params(labelsize=_small(), length=2, pad=1.5)
    first, last = axes[0, 0].get_position(), axes[3, 3].get_position()
    middle = (first.x0 + last.x1) / 2, (last.y0 + first.y1) / 2
    em_x, em_y = sizes.em() / width, sizes.em() / height
    figure.text(middle[0], last.y0 - 1.9 * em_y, disc.X_LABEL, ha="center", va="top")
    figure.text(first.x0 - 1.8 * em_x, middle[1], disc.Y_LABEL, ha="right", va="center", rotation=90)
    figure.text(middle[0], first.y1 + 0.5 * em_y, title, ha="center", va="bottom")


def _draw_bars(figure, axes, bars: list[_Bar], width: float, height: float) -> None:
    """The scales one below the other on the right, each below its label."""
    first, last = axes[0, 3].get_position(), axes[3, 3].get_position()
    em_x, em_y = sizes.em() / width, sizes.em() / height
    each = (first.y1 - last.y0) / len(bars)
    for number, bar in enumerate(bars):
        lines = 1 + bar.label.count("\n")
        bottom, top = first.y1 - (number + 1) * each, first.y1 - number * each - (1.25 * lines + 0.9) * em_y
        bottom += 0.7 * em_y if number + 1 < len(bars) else 0.4 * em_y
        place = figure.add_axes((first.x1 + 1.2 * em_x, bottom, 0.9 * em_x, top - bottom))
        drawn = figure.colorbar(ScalarMappable(bar.scale.norm, bar.scale.cmap), cax=place, extend=bar.scale.extend)
        drawn.ax.tick_params(labelsize=_small(), length=2, pad=1.5)
        # With the ends among them, which are what a reader asks for.
        ticks = np.linspace(bar.scale.norm.vmin, bar.scale.norm.vmax, 5 if top - bottom > 7 * em_y else 3)
        drawn.set_ticks(ticks, labels=[f"{round(tick, 12):g}".replace("-", "\u2212") for tick in ticks])
        figure.text(
            first.x1 + 1.0 * em_x,
            top + 0.7 * em_y,
            bar.label,
            ha="left",
            va="bottom",
            fontsize=_small(),
            linespacing=1.1,
        )


def _write_key(figure, axes, view: disc.View, hatched: bool, bars: list[_Bar], height: float) -> None:
    """What is marked, and where the ends of the scales are from."""
    first, last = axes[0, 0].get_position(), axes[3, 3].get_position()
    em_y = sizes.em() / height
    at = dict(loc="upper center", bbox_to_anchor=((first.x0 + last.x1) / 2, last.y0 - 3.1 * em_y))
    style = dict(frameon=False, fontsize=_small(), handlelength=1.5, columnspacing=1.0, borderpad=0, handletextpad=0.4)
    figure.legend(handles=disc.key(view, hatched), ncol=4, **at, **style)
    said = [bar.scale.said for bar in bars if bar.scale.said]
    if said:
        words = f"scales: {', '.join(dict.fromkeys(said))}"
        figure.text((first.x0 + last.x1) / 2, last.y0 - 5.7 * em_y, words, ha="center", va="bottom", fontsize=_small())
