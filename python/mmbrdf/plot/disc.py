# SPDX-License-Identifier: BSD-3-Clause
"""The disc of projected direction cosines: where a model is evaluated for a picture, and how samples become cells."""
from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch
from matplotlib.patheffects import withStroke

import mmbrdf

from .._arguments import number, own_wavelength, require
from .colours import HATCH, HATCH_COLOUR, UNMEASURED
from .scalars import measured_in

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.image import AxesImage
    from numpy.typing import NDArray

SOURCE_AZIMUTH_DEG = 180.0
"""Azimuth of the source in pictures: light comes from the left."""


class DiscImage(NamedTuple):
    """Values on a square lattice that covers the disc; not a number where there is none.

    ``values`` has the shape (rows, columns, ...), y rising with the row; ``extent`` is (left, right, bottom, top) of
    the outermost cells' edges, in direction cosines.
    """

    values: NDArray[np.float64]
    extent: tuple[float, float, float, float]

    def centres(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """x and y of the cells' centres, each of the shape (rows, columns)."""
        left, right, bottom, top = self.extent
        rows, columns = self.values.shape[:2]
        x = left + (np.arange(columns) + 0.5) * (right - left) / columns
        y = bottom + (np.arange(rows) + 0.5) * (top - bottom) / rows
        columns_x, rows_y = np.meshgrid(x, y)
        return columns_x, rows_y

    def within(self, theta_max_deg: float | None) -> NDArray[np.bool_]:
        """Which cells have their centre in the disc, and within a polar angle if it is known."""
        edge = 1.0 if theta_max_deg is None else np.sin(np.radians(theta_max_deg))
        return np.asarray(np.hypot(*self.centres()) <= edge)


class View(NamedTuple):
    """What is marked in a picture of the hemisphere: the source, and where the fitted polar angles of detection end."""

    theta_i_deg: float
    phi_i_deg: float
    theta_max_deg: float | None = None


X_LABEL = r"$\sin\theta_\mathrm{r}\,\cos\phi_\mathrm{r}$"
Y_LABEL = r"$\sin\theta_\mathrm{r}\,\sin\phi_\mathrm{r}$"


def direction_cosines(theta_deg, phi_deg) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """x and y of directions given in degrees."""
    sine, azimuth = np.sin(np.radians(theta_deg)), np.radians(phi_deg)
    return sine * np.cos(azimuth), sine * np.sin(azimuth)


def evaluate(model, wavelength_nm, geometry, frame: str = "xy") -> NDArray[np.float64]:
    """Mueller BRDF in sr^-1, (..., 4, 4). A picture shows where the fitted range ends, so nothing warns of it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mmbrdf.ExtrapolationWarning)
        return model.evaluate(wavelength_nm, *geometry, frame=frame)


def normalized(mueller: NDArray[np.float64]) -> NDArray[np.float64]:
    """f11 as it is, all other elements divided by it; the shape is kept, (..., 4, 4)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        result = mueller / mueller[..., :1, :1]
    result[..., 0, 0] = mueller[..., 0, 0]
    return result


def question(source, wavelength_nm, theta_i_deg) -> tuple[float | None, float]:
    """Wavelength in nm and angle of incidence of a picture, checked; TypeError if ``source`` is no model or data set."""
    require("source", source, mmbrdf.Model, mmbrdf.Dataset)
    return own_wavelength(source, wavelength_nm), number("theta_i_deg", theta_i_deg)


def matrices(source, wavelength_nm, theta_i_deg: float, phi_i_deg: float, frame: str, samples: int) -> DiscImage:
    """Mueller BRDF in sr^-1 over the disc, of a model (samples x samples cells) or of a data set (its own cells)."""
    if isinstance(source, mmbrdf.Dataset):
        data = samples_at(source, wavelength_nm, theta_i_deg, phi_i_deg)
        return sample_cells(data, measured_in(data, frame))
    return over_disc(
        samples,
        lambda theta_r_deg, phi_r_deg: evaluate(
            source, wavelength_nm, (theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg), frame
        ),
    )


def sample_cells(data: mmbrdf.Dataset, values: NDArray[np.float64]) -> DiscImage:
    """Values of samples, (samples, ...), as cells."""
    return cells(*direction_cosines(data.theta_r_deg, data.phi_r_deg), values)


def over_disc(samples: int, function) -> DiscImage:
    """``function(theta_r_deg, phi_r_deg)``, which takes and returns arrays, at the cells' centres within the disc."""
    if samples < 1:
        raise ValueError(f"samples = {samples}, must be at least 1")
    blank = DiscImage(np.empty((samples, samples)), (-1.0, 1.0, -1.0, 1.0))
    x, y = blank.centres()
    rho = np.hypot(x, y)
    inside = rho < 1
    found = function(np.degrees(np.arcsin(rho[inside])), np.degrees(np.arctan2(y[inside], x[inside])))
    values = np.full((samples, samples) + found.shape[1:], np.nan)
    values[inside] = found
    return blank._replace(values=values)


def samples_at(data, wavelength_nm: float, theta_i_deg: float, phi_i_deg: float, tolerance_deg: float = 0.5):
    """The samples at a wavelength whose source is within the tolerance of a direction; ValueError if there are none."""
    # As vectors: near the normal the azimuth says nothing, and a polar angle may be stored with either sign.
    x, y = direction_cosines(data.theta_i_deg, data.phi_i_deg)
    x0, y0 = direction_cosines(theta_i_deg, phi_i_deg)
    cosine = x * x0 + y * y0 + np.cos(np.radians(data.theta_i_deg)) * np.cos(np.radians(theta_i_deg))
    near = np.degrees(np.arccos(np.clip(cosine, -1, 1))) <= tolerance_deg
    chosen = near & np.isclose(data.wavelength_nm, wavelength_nm, rtol=1e-6)
    if not chosen.any():
        raise ValueError(
            f"no samples at {wavelength_nm:g} nm with the source at theta_i = {theta_i_deg:g}, "
            f"phi_i = {phi_i_deg:g} degrees"
        )
    return data[chosen]


def cells(x: NDArray[np.float64], y: NDArray[np.float64], values: NDArray[np.float64]) -> DiscImage:
    """Samples as cells: those of their square lattice if they lie on one, else of the nearest sample."""
    lattice = _lattice(x, y)
    if lattice is None:
        return _nearest(x, y, values)
    columns, rows, spacing = lattice
    image = np.full((rows.max() + 1, columns.max() + 1) + values.shape[1:], np.nan)
    image[rows, columns] = values
    left, bottom = x.min() - spacing / 2, y.min() - spacing / 2
    return DiscImage(image, (left, left + image.shape[1] * spacing, bottom, bottom + image.shape[0] * spacing))


def _lattice(x, y):
    """Column and row of each sample and the spacing, or None if the samples do not fill a square lattice."""
    steps = np.concatenate([np.diff(np.unique(np.round(axis, 4))) for axis in (x, y)])
    steps = steps[steps > 5e-4]  # smaller ones are the rounding of angles
    if steps.size == 0:
        return None
    span = max(np.ptp(x), np.ptp(y))
    spacing = span / np.round(span / np.median(steps))
    places = [(axis - axis.min()) / spacing for axis in (x, y)]
    columns, rows = (np.round(place).astype(int) for place in places)
    off = max(np.abs(places[0] - columns).max(), np.abs(places[1] - rows).max())
    distinct = len(np.unique(columns * (rows.max() + 1) + rows)) == len(x)
    filled = len(x) > 0.3 * (columns.max() + 1) * (rows.max() + 1)
    return (columns, rows, spacing) if off < 0.1 and distinct and filled else None


def _nearest(x, y, values, samples: int = 101) -> DiscImage:
    """The nearest sample's values, up to one and a half times the usual distance between neighbours from it."""
    places = np.column_stack([x, y])
    reach = 0.1
    if len(places) > 1:
        between = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
        np.fill_diagonal(between, np.inf)
        reach = 1.5 * np.median(between.min(axis=1))

    def look_up(theta_r_deg, phi_r_deg):
        at = np.column_stack(direction_cosines(theta_r_deg, phi_r_deg))
        found = np.full((len(at),) + values.shape[1:], np.nan)
        for some in np.array_split(np.arange(len(at)), 1 + len(at) * len(places) // 1_000_000):
            distance = np.hypot(*(at[some, None] - places[None]).transpose(2, 0, 1))
            near = distance.min(axis=1) <= reach
            found[some[near]] = values[distance.argmin(axis=1)[near]]
        return found

    return over_disc(samples, look_up)


def draw(axes: Axes, image: DiscImage, cmap, norm, label_axes: bool = False) -> AxesImage:
    """One scalar picture, (rows, columns), clipped to the unit disc, with its outline; hatched where there is no number."""
    drawn = axes.imshow(
        np.ma.masked_invalid(image.values),
        extent=image.extent,
        origin="lower",
        cmap=cmap,
        norm=norm,
        interpolation="nearest",
        zorder=1,
    )
    hatched = dict(hatch=HATCH, facecolor=UNMEASURED, edgecolor=HATCH_COLOUR, linewidth=0) if lacks(image) else {}
    rim = Circle((0, 0), 1, **{"facecolor": "white", "edgecolor": "none", **hatched}, zorder=0)
    axes.add_patch(rim)
    drawn.set_clip_path(rim)
    axes.add_patch(Circle((0, 0), 1, facecolor="none", edgecolor="0.35", linewidth=0.5, zorder=2))
    axes.set(xlim=(-1.03, 1.03), ylim=(-1.03, 1.03), aspect="equal")
    axes.spines[:].set_visible(False)
    axes.set(xticks=[], yticks=[])
    if label_axes:
        axes.set(xticks=[-1, 0, 1], yticks=[-1, 0, 1], xlabel=X_LABEL, ylabel=Y_LABEL)
    return drawn


def lacks(image: DiscImage) -> bool:
    """Whether there is a cell without a number in the disc, or a part of the disc without a cell."""
    part = max(image.extent[0], image.extent[2]) > -1 or min(image.extent[1], image.extent[3]) < 1
    return part or not np.isfinite(image.values[image.within(None)]).all()


_HALO = [withStroke(linewidth=1.6, foreground="white")]
_LIMIT = dict(edgecolor="0.1", facecolor="none", linewidth=0.7, linestyle=(0, (3, 2)))


def _mark(name: str, x, y, size: float) -> Line2D:
    """The source is a ring, which is the retro direction, too; the specular direction a cross."""
    label = {"source": "source and retro", "specular": "specular"}[name]
    style = dict(linestyle="none", color="black", markerfacecolor="none", path_effects=_HALO, zorder=4, gid=name)
    marker = {"source": "o", "specular": "x"}[name]
    return Line2D(x, y, marker=marker, markersize=size, markeredgewidth=0.9, label=label, **style)


def mark(axes: Axes, view: View, size: float = 5.0) -> None:
    """Source, which is the retro direction of detection, too; specular direction; a dashed circle where the fitted directions
    of detection end, if that is known and can be told from the rim."""
    x, y = direction_cosines(view.theta_i_deg, view.phi_i_deg)
    axes.add_line(_mark("source", [x], [y], size))
    axes.add_line(_mark("specular", [-x], [-y], 0.85 * size))
    if shows_limit(view):
        radius = np.sin(np.radians(view.theta_max_deg))
        halo = [withStroke(linewidth=1.7, foreground="white")]
        axes.add_patch(Circle((0, 0), radius, **_LIMIT, zorder=3, gid="limit", path_effects=halo))


def shows_limit(view: View) -> bool:
    return view.theta_max_deg is not None and np.sin(np.radians(view.theta_max_deg)) < 0.98


def key(view: View, hatched: bool) -> list[Line2D | Patch]:
    """Handles of a legend of what is marked."""
    handles: list[Line2D | Patch] = [_mark("source", [], [], 4.5), _mark("specular", [], [], 4.0)]
    if shows_limit(view):
        handles.append(Line2D([], [], color="0.1", linewidth=0.7, linestyle=(0, (3, 2)), label="end of the fit"))
    if hatched:
        hatch = dict(facecolor=UNMEASURED, edgecolor=HATCH_COLOUR, hatch=HATCH, linewidth=0)
        handles.append(Patch(label="no value", **hatch))
    return handles
