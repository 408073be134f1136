# SPDX-License-Identifier: BSD-3-Clause
"""Curves in the plane of incidence, as in Figs. 6 and 7 of Germer (2017)."""
from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, NamedTuple, Sequence

import numpy as np
from matplotlib import rcParams
from matplotlib.lines import Line2D
from matplotlib.ticker import MultipleLocator

import mmbrdf

from .._arguments import number, own_wavelength, require, several_models, unmasked
from . import disc, labels, sizes
from .colours import COMPONENTS, UNPOLARIZED, Stroke, series
from .scalars import measured_in, sample_uncertainty, scalar

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

    from numpy.typing import NDArray

    from mmbrdf import Dataset, Model

ANGLE_LABEL = r"$\leftarrow$ source side    $\theta_\mathrm{r}$ / °    forward $\rightarrow$"
"""Of signed polar angles of detection."""

LAMBERTIAN = 1 / np.pi
"""f11 of a perfect diffuser, sr^-1."""


def in_plane(theta_i_deg: float, phi_i_deg: float, theta_r_deg) -> mmbrdf.Geometry:
    """mmbrdf.in_plane(), turned to an azimuth of the source: isotropic samples look the same from all of them.

    ValueError for a negative theta_i_deg, whose forward side would be the other one."""
    if theta_i_deg < 0:
        raise ValueError(f"theta_i_deg = {theta_i_deg:g}, must not be negative: turn the source by phi_i_deg")
    theta_i, phi_i, theta_r, phi_r = mmbrdf.in_plane(theta_i_deg, theta_r_deg)
    turn = phi_i_deg - phi_i
    return mmbrdf.Geometry(theta_i, phi_i + turn, theta_r, (phi_r + turn) % 360)


@sizes.sized
def in_plane_curves(
    model: Model,
    wavelength_nm: float | None,
    theta_i_deg: float = 45.0,
    *,
    data: Dataset | None = None,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    theta_r_deg: Sequence[float] | None = None,
    coverage: float = 2.0,
    bands: bool | None = None,
    tolerance_deg: float = 0.5,
    axes: Axes | None = None,
    linestyle: str | tuple | None = None,
    linewidth: float = 1.6,
    legend: bool = True,
    width_cm: float | None = None,
) -> tuple[Figure, Axes]:
    """BRDF between linear polarizations in the plane of incidence, with uncertainty bands (Fig. 6 of Germer 2017).

    ``theta_r_deg`` are signed polar angles of detection in degrees, positive on the forward side (-90 ... 90 in steps
    of 1 degree without it), in the plane of incidence at ``phi_i_deg``. ``bands`` are ``coverage`` standard uncertainties of the
    fit to either side, drawn if the model has a covariance. ``data`` are samples: those of this wavelength and angle of incidence
    in the plane of incidence, to ``tolerance_deg``, are points over the curves, with bars of as many of their own
    uncertainties, if they have some; their source may be at any azimuth if the model is isotropic. Without ``axes`` the
    ordinate spans the curves within the fitted angles, and the points; what lies beyond
    is grey. ``linestyle`` is one for all four lines, which have their own without it. Returns the figure and its axes; the four
    lines are drawn in the order ss, sp, ps, pp; of a model that does not know all of them it is one line, f11. ValueError if there
    are no such samples.
    """
    require("model", model, mmbrdf.Model)
    strokes = strokes_of(model)
    wavelength_nm, theta_i_deg = own_wavelength(model, wavelength_nm), number("theta_i_deg", theta_i_deg)
    angles = np.arange(-90.0, 91.0) if theta_r_deg is None else np.asarray(unmasked("theta_r_deg", theta_r_deg), float)
    geometry = in_plane(theta_i_deg, phi_i_deg, angles)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mmbrdf.ExtrapolationWarning)
        with_bands = model.has_covariance if bands is None else bands
        curves, uncertainty = _curves(model, wavelength_nm, geometry, strokes, with_bands)
    points = None
    if data is not None:
        azimuth = None if model.family == "isotropic" else phi_i_deg
        points = _measured_points(data, wavelength_nm, theta_i_deg, azimuth, tolerance_deg, strokes)
    if axes is None:
        axes = _plane_axes(
            model.theta_r_max_deg, theta_i_deg, angles, np.array(list(curves.values())), points, width_cm
        )
    for name, stroke in strokes.items():
        curve = curves[name]
        style = stroke.style if linestyle is None else linestyle
        axes.plot(angles, curve, color=stroke.color, linestyle=style, linewidth=linewidth, label=stroke.label, zorder=2)
        if uncertainty is not None:
            half = coverage * uncertainty[name]
            axes.fill_between(angles, curve - half, curve + half, color=stroke.color, alpha=0.2, linewidth=0, zorder=1)
    if points is not None:
        for name, stroke in strokes.items():
            _draw_points(axes, points, name, stroke, coverage)
    if legend:
        axes.set_title(labels.title(labels.plain(model.name), wavelength_nm, theta_i_deg, source=model))
        handles = component_handles(linewidth, linestyle, points=points is not None, strokes=strokes)
        sizes.legend_below(axes, handles, _what_is_drawn(points, with_bands, coverage), columns=4)
    return axes.figure, axes


def strokes_of(model: Model) -> dict[str, Stroke]:
    """The lines of a model: pairs of polarizations, or f11 alone where it does not know them."""
    return UNPOLARIZED if {"12", "21", "22"} & set(model.not_measured) else COMPONENTS


def _curves(model, wavelength_nm, geometry, strokes, with_uncertainty) -> tuple[dict, dict | None]:
    """Values of each line, and their uncertainties."""
    asked = wavelength_nm, *geometry
    if strokes is COMPONENTS:
        of_polarizations = (model, wavelength_nm, geometry)
        u = mmbrdf.polarized_uncertainty(*of_polarizations)._asdict() if with_uncertainty else None
        return mmbrdf.polarized_curve(*of_polarizations)._asdict(), u
    u = {"f11": model.evaluate_uncertainty(*asked)[..., 0, 0]} if with_uncertainty else None
    return {"f11": model.evaluate(*asked)[..., 0, 0]}, u


def _what_is_drawn(points: Points | None, bands: bool, coverage: float) -> str | None:
    """In words, for a legend."""
    bars = points is not None and points.u is not None
    parts = ["points: measured"] * (points is not None) + [
        f"{'bands' if bands else ''}{' and ' * (bands and bars)}{'bars' if bars else ''}: $k$ = {coverage:g}"
    ] * (bands or bars)
    return ", ".join(parts) or None


class Points(NamedTuple):
    """Measured BRDFs by line, at signed polar angles; ``u`` is None for samples without uncertainties."""

    theta_r_deg: NDArray[np.float64]
    values: dict[str, NDArray[np.float64]]
    u: dict[str, NDArray[np.float64]] | None


def _measured_points(data, wavelength_nm, theta_i_deg: float, azimuth: float | None, tolerance_deg, strokes) -> Points:
    require("data", data, mmbrdf.Dataset)
    nm = own_wavelength(data, wavelength_nm)
    sine = np.sin(np.radians(data.theta_r_deg)) * np.sin(np.radians(data.phi_r_deg - data.phi_i_deg))
    near = np.degrees(np.arcsin(np.abs(np.clip(sine, -1, 1)))) <= tolerance_deg
    near &= (np.abs(data.theta_i_deg - theta_i_deg) <= tolerance_deg) & np.isclose(data.wavelength_nm, nm, rtol=1e-6)
    if azimuth is not None:
        near &= np.abs((data.phi_i_deg - azimuth + 180) % 360 - 180) <= tolerance_deg
    if not near.any():
        raise ValueError(
            f"data: no samples at {nm:g} nm with theta_i = {theta_i_deg:g} degrees in the plane of incidence, to "
            f"{tolerance_deg:g} degrees"
        )
    chosen = data[near]
    forward = np.cos(np.radians(chosen.phi_r_deg - chosen.phi_i_deg)) <= 0
    angles = np.where(forward, 1, -1) * np.abs(chosen.theta_r_deg)
    u = None
    if strokes is UNPOLARIZED:
        if chosen.uncertainty is not None:
            u = {"f11": chosen.uncertainty[:, 0, 0]}
        return Points(angles, {"f11": chosen.f11}, u)
    measured = mmbrdf.co_and_cross_polarized(measured_in(chosen, "sp"))
    if chosen.uncertainty is not None:
        u = {name: sample_uncertainty(scalar(f"f_{name}"), chosen) for name in strokes}
    return Points(angles, {name: getattr(measured, name) for name in strokes}, u)


def _draw_points(axes: Axes, points: Points, name: str, stroke: Stroke, coverage: float) -> None:
    bars = None if points.u is None else coverage * points.u[name]
    style = dict(color=stroke.color, markerfacecolor="white", markersize=4.0, markeredgewidth=0.9, elinewidth=0.7)
    drawn = axes.errorbar(points.theta_r_deg, points.values[name], bars, fmt=stroke.marker, zorder=3, **style)
    drawn.lines[0].set_gid(f"measured-{name}")


@sizes.sized
def subset_study(
    parts: Sequence[Model],
    reference: Model,
    wavelength_nm: float | None,
    theta_i_deg: float = 45.0,
    *,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    theta_r_deg: Sequence[float] | None = None,
    axes: Axes | None = None,
    legend: bool = True,
    width_cm: float | None = None,
) -> tuple[Figure, Axes]:
    """In-plane curves of fits to disjoint parts of the data, thin, over those of a reference, thick (Fig. 7).

    ``parts`` and ``reference`` are models; wavelength in nm, angles in degrees as for ``in_plane_curves``.
    Returns the figure and its axes; the lines of the reference come first.
    """
    parts = several_models("parts", parts)
    require("reference", reference, mmbrdf.Model)
    options: dict[str, Any] = dict(phi_i_deg=phi_i_deg, theta_r_deg=theta_r_deg, bands=False, legend=False)
    options["width_cm"] = width_cm
    figure, axes = in_plane_curves(reference, wavelength_nm, theta_i_deg, axes=axes, linewidth=2.4, **options)
    for part in parts:
        in_plane_curves(part, wavelength_nm, theta_i_deg, axes=axes, linewidth=0.9, **options)
    if legend:
        thick_and_thin = [
            Line2D([], [], color="0.4", linewidth=2.4, label=labels.plain(reference.name)),
            Line2D([], [], color="0.4", linewidth=0.9, label=f"{len(parts)} disjoint parts"),
        ]
        axes.set_title(labels.title("", own_wavelength(reference, wavelength_nm), theta_i_deg))
        sizes.legend_below(axes, component_handles(strokes=strokes_of(reference)) + thick_and_thin, columns=3)
    return figure, axes


def component_handles(
    linewidth: float = 1.6,
    linestyle: str | tuple | None = None,
    *,
    points: bool = False,
    strokes: dict[str, Stroke] = COMPONENTS,
) -> list[Line2D]:
    """Lines for a legend, of the four pairs of polarizations unless of others."""
    return [
        Line2D(
            [],
            [],
            color=stroke.color,
            linewidth=linewidth,
            linestyle=stroke.style if linestyle is None else linestyle,
            label=stroke.label,
            **dict(marker=stroke.marker, markerfacecolor="white", markersize=4.0) if points else {},
        )
        for stroke in strokes.values()
    ]


@sizes.sized
def polar_in_plane(
    models: Model | Sequence[Model],
    wavelength_nm: float | Sequence[float] | None,
    theta_i_deg: float = 45.0,
    *,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    axes: PolarAxes | None = None,
    width_cm: float | None = None,
) -> tuple[Figure, PolarAxes]:
    """f11 in the plane of incidence against the signed polar angle of detection, in polar coordinates.

    ``models`` and ``wavelength_nm`` are one or several; each model is drawn at each wavelength. The normal points up,
    the forward side is on the right, an arrow is the incident light and the dotted arc a perfect diffuser, 1/pi sr^-1.
    Several curves often lie on one another: without ``axes`` a panel below has how far each is from the first, in percent.
    Returns the figure and the polar axes.
    """
    models, theta_i_deg = several_models("models", models), number("theta_i_deg", theta_i_deg)
    asked = [(model, own_wavelength(model, each)) for model in models for each in np.atleast_1d(wavelength_nm)]
    below, own = None, axes is None
    if axes is None:
        axes, below = _half_disc(len(asked), width_cm)
    theta_r_deg = np.arange(-90.0, 91.0)
    largest, first, limits = LAMBERTIAN, None, []
    for (model, wavelength), stroke in zip(asked, series(len(asked))):
        limit = 90.0 if model.theta_r_max_deg is None else model.theta_r_max_deg
        fitted = np.abs(theta_r_deg) <= limit
        f11 = disc.evaluate(model, wavelength, in_plane(theta_i_deg, phi_i_deg, theta_r_deg))[..., 0, 0]
        style = dict(color=stroke.color, linestyle=stroke.style, linewidth=1.4)
        axes.plot(
            np.radians(theta_r_deg),
            f11,
            label=labels.title(labels.plain(model.name), wavelength, source=model),
            **style,
        )
        largest = max(largest, f11[fitted].max())
        first = f11 if first is None else first
        if below is not None:
            difference = 100 * (f11 / first - 1)
            below.plot(theta_r_deg, difference, **style)
            limits += [difference[fitted].min(), difference[fitted].max()]
    lambertian = np.full(theta_r_deg.shape, LAMBERTIAN)
    axes.plot(
        np.radians(theta_r_deg),
        lambertian,
        color="0.4",
        linestyle=(0, (1, 3)),
        linewidth=0.9,
        label=r"$1/\pi$ sr$^{-1}$",
    )
    _finish_half_disc(axes, theta_i_deg, largest)
    if below is not None:
        margin = 0.08 * (max(limits) - min(limits)) or 0.1
        below.set_ylim(min(limits) - margin, max(limits) + margin)
        grey_beyond(below, min(90.0 if m.theta_r_max_deg is None else m.theta_r_max_deg for m, _ in asked))
    if own:
        style = dict(frameon=False, ncol=2, borderpad=0, bbox_transform=axes.figure.transFigure)
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 0.01), **style)
    else:
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, 0.1), frameon=False, ncol=2)
    return axes.figure, axes


def _half_disc(curves: int, width_cm: float | None) -> tuple[PolarAxes, Axes | None]:
    """Axes for a half disc, and of several curves a panel below, with room for words."""
    width = 6.0 if width_cm is None else width_cm * sizes.CM
    em = sizes.em()
    radius, panel, rows = 0.4 * width, 0.26 * width if curves > 1 else 0.0, -(-(curves + 1) // 2)
    legend = (1.5 * rows + 0.5) * em
    under = legend + (panel + 3.6 * em if panel else 0)
    height = under + 4.8 * em + radius + 4.0 * em
    picture = sizes.figure(width_cm, width, height)
    # matplotlib centres a half disc in the square of the whole one.
    place = (0.1, (under + 4.8 * em - radius / 2) / height, 0.8, 2 * radius / height)
    axes = picture.add_axes(place, projection="polar")
    if not panel:
        return axes, None
    below = picture.add_axes((0.15, (legend + 3.2 * em) / height, 0.7, panel / height))
    below.axhline(0, color="0.7", linewidth=0.5, zorder=0)
    below.set(xlim=(-90, 90), xticks=range(-90, 91, 30), xlabel=ANGLE_LABEL, ylabel="from the first / %")
    return axes, below


def _finish_half_disc(axes: PolarAxes, theta_i_deg: float, largest: float) -> None:
    """The forward side on the right, ticks, labels and the incident light."""
    axes.set(theta_zero_location="N", theta_direction=-1, thetamin=-90, thetamax=90, ylim=(0, 1.15 * largest))
    axes.set_xticks(np.radians(np.arange(-90, 91, 30)), [f"{abs(angle)}°" for angle in range(-90, 91, 30)])
    axes.yaxis.set_major_locator(MultipleLocator(0.1))
    incident = np.radians(-theta_i_deg)
    axes.annotate(
        "",
        xy=(incident, 0.12 * largest),
        xytext=(incident, 1.1 * largest),
        arrowprops=dict(arrowstyle="-|>", color="0.2"),
    )
    axes.text(0.5, 0.25, "\n\n" + ANGLE_LABEL + "\n" + r"radius $f_{\mathrm{r},11}$ / sr$^{-1}$;  arrow: incident light",
              ha="center", va="top", transform=axes.transAxes)  # fmt: skip
    axes.set_title(labels.title("", None, theta_i_deg), y=0.75, pad=2.5 * float(rcParams["font.size"]))


def _plane_axes(theta_r_max_deg: float | None, theta_i_deg: float, theta_r_deg, values, points, width_cm) -> Axes:
    """Axes with labels and units for curves of the shape (lines, angles), grey where the model was not fitted."""
    axes = sizes.figure(width_cm, 6.4, 4.6, layout="constrained").add_subplot()
    axes.set(xlim=(-90, 90), xticks=range(-90, 91, 30), ylabel=r"$f_\mathrm{r}$ / sr$^{-1}$", xlabel=ANGLE_LABEL)
    fitted = np.abs(theta_r_deg) <= (90 if theta_r_max_deg is None else theta_r_max_deg)
    shown = [values[:, fitted].ravel()] + ([] if points is None else list(points.values.values()))
    known = np.concatenate(shown)
    known = known[np.isfinite(known)]
    if known.size:
        low, high = known.min(), known.max()
        axes.set_ylim(low - 0.15 * (high - low), high + 0.15 * (high - low))
    mark_plane(axes, theta_i_deg)
    grey_beyond(axes, theta_r_max_deg)
    return axes


def grey_beyond(axes: Axes, limit_deg: float | None, largest: float = 90.0, both: bool = True) -> None:
    """Grey where a polar angle was not fitted."""
    if limit_deg is not None and limit_deg < largest:
        for sign in (-1, 1) if both else (1,):
            axes.axvspan(sign * limit_deg, sign * largest, color="0.93", zorder=0, linewidth=0)


def mark_plane(axes: Axes, theta_i_deg: float) -> None:
    """Thin lines at the specular and the retro direction, named above."""
    names = {theta_i_deg: "specular", -theta_i_deg: "retro"} if theta_i_deg else {0.0: "retro, specular"}
    line = dict(arrowstyle="-", color="0.75", linewidth=0.6, shrinkA=0, shrinkB=0)
    at = ("data", "axes fraction")
    for angle in names:
        axes.annotate("", (angle, 0), (angle, 1), xycoords=at, textcoords=at, arrowprops=line, zorder=0.5)
    top = axes.secondary_xaxis("top")
    size = 0.9 * float(rcParams["font.size"])
    top.set_xticks(list(names), list(names.values()))
    top.tick_params(labelsize=size, length=2, pad=1, color="0.5", labelcolor="0.3")
