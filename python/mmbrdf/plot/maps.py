# SPDX-License-Identifier: BSD-3-Clause
"""One number of the Mueller matrix, over the hemisphere of detection."""
from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.colors import Colormap, Normalize

import mmbrdf

from .._arguments import require, require_measured
from . import colours, disc, labels, sizes
from .scalars import SYMBOLS, Asked, Scalar, measured_in, model_uncertainty, ratio, sample_uncertainty, scalar

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure
    from numpy.typing import NDArray

    from mmbrdf import Dataset, Model

DEPOLARIZATION_LABEL = SYMBOLS["depolarization"]
UNREALIZABLE = "#d62728"
_KINDS = ("value", "u", "value / u")


class Scale(NamedTuple):
    """Of colours; ``said`` is where its ends are from, "" if they were given."""

    cmap: Colormap | str
    norm: Normalize
    extend: str
    said: str


def chosen_scale(
    values: NDArray[np.float64],
    fitted: NDArray[np.bool_],
    *,
    measured: bool,
    limits: tuple[float, float] | None = None,
    cmap: Colormap | str | None = None,
    signed: bool | None = None,
) -> Scale:
    """Ends of a scale for these values, chosen among those that are ``fitted``, rounded outwards to hundredths of the span.

    From the smallest to the largest of a model, from the 1st to the 99th percentile of what was measured, which has outliers.
    Values of both signs (``signed`` says it, else they do) have the same ends on both sides of zero, and colours of their own.
    """
    inside = values[fitted & np.isfinite(values)]
    if inside.size == 0:
        inside = np.zeros(1)
    low, high = np.percentile(inside, (1, 99)) if measured else (inside.min(), inside.max())
    if signed is None:
        signed = bool(low < 0 < high and min(-low, high) > 0.02 * max(-low, high))
    said = "1 to 99 % of the samples" if measured else "range within the fit"
    if limits is not None:
        (low, high), said = limits, ""
    else:
        if signed:
            high = max(abs(low), abs(high))
            low = -high
        low, high = _outwards(float(low), float(high))
    known = values[np.isfinite(values)]
    below, above = bool((known < low).any()), bool((known > high).any())
    extend = {(True, True): "both", (True, False): "min", (False, True): "max"}.get((below, above), "neither")
    return Scale(cmap or (colours.SIGNED if signed else colours.VALUES), Normalize(low, high), extend, said)


def _outwards(low: float, high: float) -> tuple[float, float]:
    span = high - low
    if not span > 1e-9 * max(abs(low), abs(high)):
        span = abs(high) or 1.0
        low, high = low - span / 2, high + span / 2
    step = 10.0 ** (np.floor(np.log10(span)) - 1)
    return float(np.floor(low / step + 1e-9) * step), float(np.ceil(high / step - 1e-9) * step)


class Shown(NamedTuple):
    """What a map shows of one number."""

    image: disc.DiscImage
    label: str
    measured: bool


@sizes.sized
def map(
    source: Model | Dataset,
    quantity: Asked = "11",
    wavelength_nm: float | None = None,
    theta_i_deg: float = 45.0,
    *,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    minus: Model | None = None,
    show: str = "value",
    frame: str | None = None,
    stokes: Sequence[float] | None = None,
    terms: dict[str, float] | None = None,
    samples: int | None = None,
    limits: tuple[float, float] | None = None,
    cmap: Colormap | str | None = None,
    label: str | None = None,
    title: str | None = None,
    axes: Axes | None = None,
    colorbar: bool = True,
    width_cm: float | None = None,
) -> tuple[Figure | SubFigure, Axes]:
    """Any number of the Mueller matrix over the hemisphere of detection, of a model or of samples.

    ``quantity`` is "11" (f11 in sr^-1), "12" ... "44" (divided by f11), "reflectance_factor", a name of
    ``mmbrdf.quantities()``, for which matrices are in the frame sp and which may need ``stokes``, the incident light; or any
    function of matrices (..., 4, 4) in sr^-1 in the ``frame`` (xy without one) that returns (...), nan where it has no value.
    The picture says the frame. ``minus`` is a model whose number is subtracted: what a fit leaves of samples, or how two models
    differ. ``show`` is "value", "u", its standard uncertainty in first order, with ``terms`` of type B, or "value / u".
    That of samples is from their own uncertainties, of a difference from both sides as if they were independent.

    A ring is the source, which is the retro direction, too; a cross the specular direction; a dashed circle the end of the
    fitted polar angles; hatched is what has no value. ``limits`` are the ends of the colour scale; without them they are the
    smallest and the largest value within the fitted angles, or three times the root mean square to both sides of 0 for
    differences of samples, or the 1st and 99th percentile of samples, and the scale says so. A model is asked at
    ``samples`` x ``samples`` places (201; 61 for u). Wavelength in nm, angles in degrees.

    Returns the figure and its axes. ValueError for an unknown name or frame, and where there is no u.
    """
    wavelength_nm, theta_i_deg = disc.question(source, wavelength_nm, theta_i_deg)
    if show not in _KINDS:
        raise ValueError(f"show = {show!r}, expected one of {', '.join(_KINDS)}")
    if terms and show == "value":
        raise ValueError("terms: they count in u, so show must be u or value / u")
    asked = scalar(quantity, frame, stokes)
    view = disc.View(theta_i_deg, phi_i_deg, getattr(source, "theta_r_max_deg", None))
    found = shown(asked, source, minus, show, wavelength_nm, view, terms, samples)
    if minus is not None and limits is None and found.measured and show != "u":
        scale = residual_scale(found.image.values, show == "value / u", cmap)
    else:
        scale = chosen_scale(
            found.image.values,
            found.image.within(view.theta_max_deg),
            measured=found.measured,
            limits=limits,
            cmap=cmap,
            signed=True if minus is not None and show != "u" else None,
        )
    name = named(source, minus)
    title = labels.title(name, wavelength_nm, theta_i_deg, asked.frame, source) if title is None else title
    return draw_map(found.image, scale, view, label or found.label, title, axes, colorbar, width_cm)


def named(source: Model | Dataset, minus: Model | None = None) -> str:
    """ "measured", or the name of the model, less that of another; those without a name are told apart as well."""
    name = "measured" if isinstance(source, mmbrdf.Dataset) else labels.plain(source.name)
    if minus is None:
        return name
    return f"{name or 'model'} $-$ {labels.plain(minus.name) or ('model' if name else 'another')}"


def residual_scale(values: NDArray[np.float64], over_u: bool, cmap: Colormap | str | None = None) -> Scale:
    """For what a fit leaves: three times its root mean square to both sides of zero, or 3 where it is divided by u."""
    known = values[np.isfinite(values)]
    rms = float(np.sqrt(np.mean(known**2))) if known.size else 0.0
    end = 3.0 if over_u else _outwards(0.0, 3 * rms)[1] if rms > 0 else 1.0
    said = "" if over_u else "3 rms to each side"
    return chosen_scale(
        values, np.isfinite(values), measured=True, limits=(-end, end), cmap=cmap, signed=True
    )._replace(said=said)


def shown(asked: Scalar, source, minus, show: str, wavelength_nm, view: disc.View, terms, samples) -> Shown:
    """Of a model on a lattice, of samples in their cells; ``show`` as map() has it."""
    measured = isinstance(source, mmbrdf.Dataset)
    label = asked.label
    if minus is not None:
        require("minus", minus, mmbrdf.Model)
        label = f"difference of {label}"
    if show != "value":
        symbol, slash, unit = label.partition(" / ")
        label = f"u({symbol}){slash}{unit}" if show == "u" else f"{symbol} / u"
    if measured:
        data = disc.samples_at(source, wavelength_nm, view.theta_i_deg, view.phi_i_deg)
        where, mueller = data.geometry, measured_in(data, asked.frame)
        found = _values(asked, mueller, data, minus, show, wavelength_nm, where, terms)
        return Shown(disc.sample_cells(data, found), label, True)

    def over(theta_r_deg, phi_r_deg):
        where = tuple(np.broadcast_arrays(view.theta_i_deg, view.phi_i_deg, theta_r_deg, phi_r_deg))
        mueller = disc.evaluate(source, wavelength_nm, where, asked.frame)
        return _values(asked, mueller, source, minus, show, wavelength_nm, where, terms)

    return Shown(disc.over_disc((201 if show == "value" else 61) if samples is None else samples, over), label, False)


def _values(asked: Scalar, mueller, source, minus, show: str, wavelength_nm, where, terms) -> NDArray[np.float64]:
    """What map() shows of matrices, their source being a model or samples."""
    values = np.asarray(asked.values(mueller), float)
    if values.shape != mueller.shape[:-2]:
        raise ValueError(f"quantity: gives an array of the shape {values.shape} of matrices of {mueller.shape}")
    if minus is not None:
        values = values - np.asarray(asked.values(disc.evaluate(minus, wavelength_nm, where, asked.frame)), float)
        if asked.name == "orientation_deg":  # of an ellipse, which half a turn leaves as it is
            values = (values + 90) % 180 - 90
    if show == "value":
        return values
    variance = np.zeros(values.shape)
    for side in (source, minus):
        if side is not None:
            variance += _uncertainty(asked, side, wavelength_nm, where, terms) ** 2
    u = np.sqrt(variance)
    return u if show == "u" else ratio(values, u)


def _uncertainty(asked: Scalar, source, wavelength_nm, where, terms) -> NDArray[np.float64]:
    if isinstance(source, mmbrdf.Dataset):
        return sample_uncertainty(asked, source)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mmbrdf.ExtrapolationWarning)
        return model_uncertainty(asked, source, wavelength_nm, where, terms)


def draw_map(
    image: disc.DiscImage, scale: Scale, view: disc.View, label: str, title: str, axes, colorbar: bool, width_cm=None
) -> tuple[Any, Axes]:
    """One disc with all that is marked, its scale and the words for both."""
    own, place = axes is None, None
    if own:
        axes, place = _own_axes(width_cm, colorbar)
    figure = axes.figure
    drawn = disc.draw(axes, image, scale.cmap, scale.norm, label_axes=True)
    disc.mark(axes, view)
    axes.set_title(title)
    if own:
        handles = disc.key(view, disc.lacks(image))
        sizes.legend_below(axes, handles, ems=3.4, columns=2 if len(handles) == 4 else 3, handlelength=1.6)
    if colorbar:
        bar = figure.colorbar(
            drawn, extend=scale.extend, **dict(ax=axes, shrink=0.9) if place is None else dict(cax=place)
        )
        bar.set_label(label + (f"\n({scale.said})" if scale.said else ""))
    return figure, axes


def _own_axes(width_cm: float | None, colorbar: bool) -> tuple[Axes, Axes | None]:
    """A square for a disc, with room for words and, if there is one, a place for its scale."""
    em, width = sizes.em(), 4.6 if width_cm is None else width_cm * sizes.CM
    left, right, bottom, top = (em * room for room in (4.2, 10.5 if colorbar else 1.0, 7.2, 2.2))
    side = width - left - right
    height = side + bottom + top
    figure = labels.Picture(figsize=(width, height))
    axes = figure.add_axes((left / width, bottom / height, side / width, side / height))
    if not colorbar:
        return axes, None
    across = (left + side + 1.2 * em) / width
    return axes, figure.add_axes((across, (bottom + 0.06 * side) / height, 1.1 * em / width, 0.88 * side / height))


def depolarization_map(
    source: Model | Dataset,
    wavelength_nm: float | None,
    theta_i_deg: float,
    *,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    samples: int = 201,
    limits: tuple[float, float] | None = None,
    axes: Axes | None = None,
    colorbar: bool = True,
    width_cm: float | None = None,
) -> tuple[Figure | SubFigure, Axes]:
    """Gil and Bernabeu's depolarization parameter over the hemisphere (Fig. 5 of Germer 2017): ``map`` of "depolarization".

    0 where the light is depolarized completely, 1 where not at all. Of data, noise makes the parameter too large.
    Where f11 is not positive, as models may have it near grazing angles, there is none.
    """
    require_measured(source)
    return map(
        source,
        "depolarization",
        wavelength_nm,
        theta_i_deg,
        phi_i_deg=phi_i_deg,
        samples=samples,
        limits=limits,
        axes=axes,
        colorbar=colorbar,
        width_cm=width_cm,
    )


@sizes.sized
def realizability_map(
    source: Model | Dataset,
    wavelength_nm: float | None,
    theta_i_deg: float,
    *,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    samples: int = 201,
    limits: tuple[float, float] | None = None,
    axes: Axes | None = None,
    colorbar: bool = True,
    width_cm: float | None = None,
) -> tuple[Figure | SubFigure, Axes]:
    """How far the Mueller matrices are from those that no scatterer can have.

    ``map`` of the smallest eigenvalue of the coherency matrix divided by f11: 1/4 for a perfect depolarizer, 0 at the edge.
    Directions are red where it or f11 is negative; without ``limits`` the scale holds all others of the disc.
    """
    require_measured(source)
    wavelength_nm, theta_i_deg = disc.question(source, wavelength_nm, theta_i_deg)
    view = disc.View(theta_i_deg, phi_i_deg, getattr(source, "theta_r_max_deg", None))
    found = shown(scalar(_margin), source, None, "value", wavelength_nm, view, None, samples)
    values = found.image.values
    # All that can be has a place on the scale, beyond the fit too: red is for nothing else.
    can_be = found.image.within(None) & (values >= 0)
    scale = chosen_scale(values, can_be, measured=False, limits=limits, cmap=colours.with_fault_colour(UNREALIZABLE))
    if limits is None:
        said = "red: cannot exist" if (values[np.isfinite(values)] < 0).any() else "range of the disc"
        scale = scale._replace(norm=Normalize(max(scale.norm.vmin, 0.0), scale.norm.vmax), said=said)
    title = labels.title(named(source), wavelength_nm, theta_i_deg, source=source)
    return draw_map(found.image, scale, view, SYMBOLS["eigenvalue_min"], title, axes, colorbar, width_cm)


def _margin(mueller: NDArray[np.float64]) -> NDArray[np.float64]:
    """-1, as bad as can be, where f11 is not positive: the light would be less than none."""
    margin = np.asarray(mmbrdf.realizability_margin(mueller, invalid="nan"))
    return np.where(mueller[..., 0, 0] <= 0, -1.0, margin)
