# SPDX-License-Identifier: BSD-3-Clause
"""Reflectances of a model: the reflectance factor against the source's zenith angle, and what a hemisphere receives."""
from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

import mmbrdf

from .._arguments import number, own_wavelength, require, unmasked
from . import disc, labels, sizes
from .colours import STYLES, Stroke, series
from .curves import grey_beyond

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from mmbrdf import Model

ZENITH_LABEL = r"source zenith angle $\theta_\mathrm{i}$ / °"


@sizes.sized
def reflectance_factor(
    model: Model,
    wavelength_nm: float | Sequence[float] | None,
    *,
    views: Sequence[tuple[float, float]] = ((0.0, 0.0),),
    theta_i_deg: Sequence[float] | None = None,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    terms: dict[str, float] | None = None,
    coverage: float = 2.0,
    bands: bool | None = None,
    axes: Axes | None = None,
    width_cm: float | None = None,
) -> tuple[Figure, Axes]:
    """The reflectance factor of unpolarized light, pi f11, against the zenith angle of the source: a plaque as remote sensing
    uses it.

    A colour for each of the wavelengths (nm), a line style for each of the ``views``: zenith angle of the detector and its
    azimuth from the source's, in degrees; 180 is forward, 0 on the source's side. ``theta_i_deg`` are 0 to 85 degrees without
    it; grey is what was not fitted. ``bands`` are ``coverage`` standard uncertainties to either side, drawn if the model has a
    covariance, with ``terms`` of type B beside what the model knows of itself. Legend entries say which wavelengths are beyond
    or between those of the fit. Returns the figure and its axes; lines go by wavelength, then by view.
    """
    require("model", model, mmbrdf.Model)
    angles = np.arange(0.0, 86.0) if theta_i_deg is None else _several("theta_i_deg", theta_i_deg)
    wavelengths = [own_wavelength(model, each) for each in np.atleast_1d(wavelength_nm)]
    views = [_view(*each) for each in views]
    factor = float(mmbrdf.reflectance_factor(1.0))
    axes = _axes(axes, width_cm, ZENITH_LABEL, r"reflectance factor $\pi f_{\mathrm{r},11}\;\mathrm{sr}$")
    for nm, stroke in zip(wavelengths, series(len(wavelengths))):
        for (theta_r, azimuth), style in zip(views, _styles(len(views))):
            where = angles, phi_i_deg, theta_r, phi_i_deg + azimuth
            value, u = _with_uncertainty(
                model.has_covariance if bands is None else bands,
                lambda: factor * model.evaluate(nm, *where)[..., 0, 0],
                lambda: factor * model.evaluate_uncertainty(nm, *where, terms=terms)[..., 0, 0],
            )
            band(axes, angles, value, u, coverage, stroke._replace(style=style))
    handles = _wavelength_handles(model, wavelengths, linewidth=2.4, linestyle="-") + [
        Line2D([], [], color="0.2", linestyle=style, label=rf"$\theta_\mathrm{{r}}$ = {view[0]:g}°" + _side(*view))
        for view, style in zip(views, _styles(len(views)))
    ]
    return _finished(axes, model, angles, wavelengths, handles, _words(model, bands, coverage, terms))


def _finished(axes: Axes, model: Model, angles, wavelengths, handles: list[Line2D], words: str) -> tuple[Figure, Axes]:
    """A picture against the angle of the source, with all but its lines."""
    wavelength = wavelengths[0] if len(wavelengths) == 1 else None
    title = labels.title(labels.plain(model.name), wavelength, source=model)
    axes.set(title=title, xlim=(angles.min(), angles.max()))
    grey_beyond(axes, model.theta_i_max_deg, angles.max(), both=False)
    _scale_to(axes, angles, model.theta_i_max_deg)
    _legend_below(axes, handles, words)
    return axes.figure, axes


def _styles(count: int) -> list[Any]:
    return [STYLES[n % len(STYLES)] for n in range(count)]


def _view(theta_r_deg: float, azimuth_deg: float) -> tuple[float, float]:
    """A negative polar angle means the opposite azimuth."""
    theta_r_deg, azimuth_deg = number("views", theta_r_deg), number("views", azimuth_deg)
    return abs(theta_r_deg), azimuth_deg + (180 if theta_r_deg < 0 else 0)


def _side(theta_r_deg: float, azimuth_deg: float) -> str:
    """ ", forward" and the like."""
    if theta_r_deg == 0:
        return ""
    azimuth = azimuth_deg % 360
    return {0.0: ", source side", 180.0: ", forward"}.get(azimuth, rf", $\Delta\phi$ = {azimuth_deg:g}°")


def _with_uncertainty(wanted: bool, value: Callable[[], Any], u: Callable[[], Any]) -> tuple[NDArray, NDArray | None]:
    """Both without a word of extrapolation: the picture shows where it begins."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mmbrdf.ExtrapolationWarning)
        return np.asarray(value()), np.asarray(u()) if wanted else None


def band(axes: Axes, x, value, u, coverage: float, stroke: Stroke) -> Line2D:
    """A line, and ``coverage`` u to either side."""
    (line,) = axes.plot(x, value, color=stroke.color, linestyle=stroke.style, linewidth=1.4, zorder=2)
    line.set_label(stroke.label)
    if u is not None:
        half = coverage * u
        axes.fill_between(x, value - half, value + half, color=stroke.color, alpha=0.15, linewidth=0, zorder=1)
        edges = [np.column_stack([x, value + side * half]) for side in (-1, 1)]
        style = dict(colors=stroke.color, linestyles=[stroke.style], linewidths=0.5, alpha=0.7, zorder=1)
        axes.add_collection(LineCollection(edges, **style))
    return line


def _axes(axes: Axes | None, width_cm: float | None, xlabel: str, ylabel: str) -> Axes:
    axes = sizes.figure(width_cm, 6.0, 4.6, layout="constrained").add_subplot() if axes is None else axes
    axes.set(xlabel=xlabel, ylabel=ylabel)
    return axes


def _words(model: Model, bands: bool | None, coverage: float, terms: dict[str, float] | None) -> str:
    """What bands are of, for a legend; "" without."""
    if not (model.has_covariance if bands is None else bands):
        return ""
    source = "of the sample" if model.provenance.get("uncertainty") == "sample" else "of the fit"
    return f"bands: $k$ = {coverage:g}, {source}" + (f", {' and '.join(terms)}" if terms else "")


def _legend_below(axes: Axes, handles: list[Line2D], words: str) -> None:
    if not handles and not words:
        return
    sizes.legend_below(axes, handles, words)


def _wavelength_handles(model: Model, wavelengths: Sequence[float | None], **style: Any) -> list[Line2D]:
    """A line for each of several wavelengths; those that were not fitted are said to be so."""
    if len(wavelengths) < 2:
        return []
    return [
        Line2D([], [], label=f"{nm:g} nm{labels.not_fitted(model, nm)}", **{**own, **style})
        for nm, stroke in zip(wavelengths, series(len(wavelengths)))
        for own in [{"color": stroke.color, "linestyle": stroke.style}]
        if nm is not None
    ]


def _several(name: str, values: Any) -> NDArray:
    """Abscissae of a curve. ValueError for fewer than two."""
    result = np.atleast_1d(np.asarray(unmasked(name, values), float))
    if result.ndim != 1 or result.size < 2:
        raise ValueError(f"{name}: a curve needs two values at least")
    return result


def _scale_to(axes: Axes, x, limit: float | None) -> None:
    """The ordinate spans what was fitted, with its bands."""
    inside = np.asarray(x) <= (np.inf if limit is None else limit)
    if not inside.any():
        return
    ends = [np.asarray(line.get_ydata())[inside] for line in axes.lines]
    for each in axes.collections:
        vertices = each.get_paths()[0].vertices
        ends.append(vertices[np.isin(vertices[:, 0], np.asarray(x)[inside]), 1])
    values = np.concatenate(ends)
    values = values[np.isfinite(values)]
    if values.size and np.ptp(values) > 0:
        axes.set_ylim(values.min() - 0.06 * np.ptp(values), values.max() + 0.06 * np.ptp(values))


@sizes.sized
def reflectance_against_angle(
    model: Model,
    wavelength_nm: float | Sequence[float] | None,
    *,
    theta_i_deg: Sequence[float] | None = None,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    terms: dict[str, float] | None = None,
    coverage: float = 2.0,
    bands: bool | None = None,
    axes: Axes | None = None,
    width_cm: float | None = None,
) -> tuple[Figure, Axes]:
    """The directional-hemispherical reflectance (DHR) of unpolarized light against the angle of incidence, a line for each
    wavelength (nm), with bands as those of ``reflectance_factor``. ``theta_i_deg`` are 0 to 85 degrees in steps of 2.5
    without it. Returns the figure and its axes."""
    require("model", model, mmbrdf.Model)
    angles = np.arange(0.0, 86.0, 2.5) if theta_i_deg is None else _several("theta_i_deg", theta_i_deg)
    wavelengths = [own_wavelength(model, each) for each in np.atleast_1d(wavelength_nm)]
    axes = _axes(
        axes, width_cm, r"angle of incidence $\theta_\mathrm{i}$ / °", "directional-hemispherical\nreflectance"
    )
    for nm, stroke in zip(wavelengths, series(len(wavelengths))):
        value, u = _dhr(model, nm, angles, phi_i_deg, terms, bands)
        band(axes, angles, value, u, coverage, stroke)
    handles = _wavelength_handles(model, wavelengths)
    return _finished(axes, model, angles, wavelengths, handles, _words(model, bands, coverage, terms))


def _dhr(model, nm, theta_i_deg, phi_i_deg, terms, bands) -> tuple[NDArray, NDArray | None]:
    return _with_uncertainty(
        model.has_covariance if bands is None else bands,
        lambda: mmbrdf.directional_hemispherical_reflectance(model, nm, theta_i_deg, phi_i_deg),
        lambda: mmbrdf.directional_hemispherical_uncertainty(model, nm, theta_i_deg, phi_i_deg, terms=terms),
    )


@sizes.sized
def reflectance_against_wavelength(
    model: Model,
    wavelength_nm: Sequence[float] | None = None,
    *,
    theta_i_deg: float | Sequence[float] = 8.0,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    terms: dict[str, float] | None = None,
    coverage: float = 2.0,
    bands: bool | None = None,
    axes: Axes | None = None,
    width_cm: float | None = None,
) -> tuple[Figure, Axes]:
    """The DHR against the wavelength (nm), a line for each angle of incidence, with bands as those of ``reflectance_factor``.

    Points are at the wavelengths that the model was fitted to: between them it interpolates, and what is grey lies beyond.
    Without ``wavelength_nm`` 61 from the first to the last of these. Returns the figure and its axes. ValueError for a model
    that does not know its wavelengths, or has only one, unless they are given.
    """
    require("model", model, mmbrdf.Model)
    fitted = np.array(model.wavelengths_nm, float)
    if wavelength_nm is None:
        if fitted.size < 2:
            raise ValueError("wavelength_nm: the model was not fitted to several wavelengths, give those to draw")
        wavelength_nm = np.linspace(fitted.min(), fitted.max(), 61)
    nm = _several("wavelength_nm", wavelength_nm)
    nm = np.unique(np.concatenate([nm, fitted[(fitted >= nm.min()) & (fitted <= nm.max())]]))
    angles = [number("theta_i_deg", angle) for angle in np.atleast_1d(theta_i_deg)]
    axes = _axes(axes, width_cm, r"wavelength $\lambda$ / nm", "directional-hemispherical\nreflectance")
    at = np.isin(nm, fitted)
    handles = []
    for angle, stroke in zip(angles, series(len(angles))):
        value, u = _dhr(model, nm, angle, phi_i_deg, terms, bands)
        line = band(axes, nm, value, u, coverage, stroke)
        line.set(marker=stroke.marker, markevery=np.flatnonzero(at).tolist(), markersize=4.5, markerfacecolor="white")
        style = dict(
            color=stroke.color, linestyle=stroke.style, marker=stroke.marker, markerfacecolor="white", markersize=4.5
        )
        handles.append(Line2D([], [], label=rf"$\theta_\mathrm{{i}}$ = {angle:g}°", **style))
    if fitted.size:
        for low, high in ((nm.min(), fitted.min()), (fitted.max(), nm.max())):
            if high > low:
                axes.axvspan(low, high, color="0.93", zorder=0, linewidth=0)
    axes.set(title=labels.plain(model.name), xlim=(nm.min(), nm.max()))
    _scale_to(axes, nm, None)
    words = ", ".join(
        part for part in ("points: fitted" * bool(at.any()), _words(model, bands, coverage, terms)) if part
    )
    _legend_below(axes, handles, words)
    return axes.figure, axes
