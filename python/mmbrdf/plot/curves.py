# SPDX-License-Identifier: BSD-3-Clause
"""Curves in the plane of incidence, as in Figs. 6 and 7 of Germer (2017)."""
from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, Sequence

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import MultipleLocator

import mmbrdf

from .._arguments import number, own_wavelength, require, require_measured, several_models
from . import disc, labels

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

    from mmbrdf import Model

COMPONENTS = {
    "ss": ("black", r"s $\rightarrow$ s"),
    "sp": ("#d62728", r"s $\rightarrow$ p"),
    "ps": ("#2ca02c", r"p $\rightarrow$ s"),
    "pp": ("#1f5fd0", r"p $\rightarrow$ p"),
}
"""Colour and label of each pair of linear polarizations; the incident one is first."""

LAMBERTIAN = 1 / np.pi
"""f11 of a perfect diffuser, sr^-1."""


def in_plane(theta_i_deg: float, phi_i_deg: float, theta_r_deg) -> mmbrdf.Geometry:
    """mmbrdf.in_plane(), turned to an azimuth of the source: isotropic samples look the same from all of them."""
    theta_i, phi_i, theta_r, phi_r = mmbrdf.in_plane(theta_i_deg, theta_r_deg)
    turn = phi_i_deg - phi_i
    return mmbrdf.Geometry(theta_i, phi_i + turn, theta_r, (phi_r + turn) % 360)


def in_plane_curves(
    model: Model,
    wavelength_nm: float | None,
    theta_i_deg: float = 45.0,
    *,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    theta_r_deg: Sequence[float] | None = None,
    coverage: float = 2.0,
    bands: bool | None = None,
    axes: Axes | None = None,
    linestyle: str | tuple = "-",
    linewidth: float = 1.6,
    legend: bool = True,
) -> tuple[Figure, Axes]:
    """BRDF between linear polarizations in the plane of incidence, with uncertainty bands (Fig. 6 of Germer 2017).

    ``theta_r_deg`` are signed polar angles of detection in degrees, positive on the forward side (-90 ... 90 in steps
    of 1 degree without it), in the plane of incidence at ``phi_i_deg``. ``bands`` are ``coverage`` standard uncertainties of the fit to either side, drawn if the
    model has a covariance. Without ``axes`` the ordinate spans the curves within the fitted angles; what lies beyond
    is grey. Returns the figure and its axes; the four lines are drawn in the order of ``COMPONENTS``.
    """
    require("model", model, mmbrdf.Model)
    require_measured(model, ("12", "21", "22"))
    wavelength_nm, theta_i_deg = own_wavelength(model, wavelength_nm), number("theta_i_deg", theta_i_deg)
    angles = np.arange(-90.0, 91.0) if theta_r_deg is None else np.asarray(theta_r_deg, float)
    geometry = in_plane(theta_i_deg, phi_i_deg, angles)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mmbrdf.ExtrapolationWarning)
        curves = mmbrdf.polarized_curve(model, wavelength_nm, geometry)
        with_bands = model.has_covariance if bands is None else bands
        uncertainty = mmbrdf.polarized_uncertainty(model, wavelength_nm, geometry) if with_bands else None
    if axes is None:
        axes = _plane_axes(model.theta_r_max_deg, angles, np.array(curves))
    for name, (color, label) in COMPONENTS.items():
        curve = getattr(curves, name)
        axes.plot(angles, curve, color=color, linestyle=linestyle, linewidth=linewidth, label=label)
        if uncertainty is not None:
            half = coverage * getattr(uncertainty, name)
            axes.fill_between(angles, curve - half, curve + half, color=color, alpha=0.2, linewidth=0)
    if legend:
        axes.set_title(labels.title(labels.plain(model.name), wavelength_nm, theta_i_deg))
        axes.legend(handles=component_handles(), frameon=False, ncol=2)
    return axes.figure, axes


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
) -> tuple[Figure, Axes]:
    """In-plane curves of fits to disjoint parts of the data, thin, over those of a reference, thick (Fig. 7).

    ``parts`` and ``reference`` are models; wavelength in nm, angles in degrees as for ``in_plane_curves``.
    Returns the figure and its axes; the four lines of the reference come first.
    """
    parts = several_models("parts", parts)
    require("reference", reference, mmbrdf.Model)
    options: dict[str, Any] = dict(phi_i_deg=phi_i_deg, theta_r_deg=theta_r_deg, bands=False, legend=False)
    figure, axes = in_plane_curves(reference, wavelength_nm, theta_i_deg, axes=axes, linewidth=2.4, **options)
    for part in parts:
        in_plane_curves(part, wavelength_nm, theta_i_deg, axes=axes, linewidth=0.7, **options)
    if legend:
        thick_and_thin = [
            Line2D([], [], color="0.4", linewidth=2.4, label=labels.plain(reference.name)),
            Line2D([], [], color="0.4", linewidth=0.7, label=f"{len(parts)} disjoint parts"),
        ]
        axes.legend(handles=component_handles() + thick_and_thin, frameon=False, ncol=2)
    return figure, axes


def component_handles(linewidth: float = 1.6) -> list[Line2D]:
    """Lines for a legend of the four pairs of polarizations."""
    return [Line2D([], [], color=color, linewidth=linewidth, label=label) for color, label in COMPONENTS.values()]


def polar_in_plane(
    models: Model | Sequence[Model],
    wavelength_nm: float | Sequence[float] | None,
    theta_i_deg: float = 45.0,
    *,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    axes: PolarAxes | None = None,
) -> tuple[Figure, PolarAxes]:
    """f11 in the plane of incidence against the signed polar angle of detection, in polar coordinates.

    ``models`` and ``wavelength_nm`` are one or several; each model is drawn at each wavelength. The normal points up,
    the forward side is on the right, an arrow is the incident light and the dotted arc a perfect diffuser, 1/pi sr^-1.
    Returns the figure and its axes.
    """
    models, theta_i_deg = several_models("models", models), number("theta_i_deg", theta_i_deg)
    if axes is None:
        # The half disc fills the upper half of its square; what is below it holds the label and the legend.
        axes = labels.Picture(figsize=(6.0, 4.3)).add_axes((0.06, -0.12, 0.88, 1.23), projection="polar")
    theta_r_deg = np.arange(-90.0, 91.0)
    largest = LAMBERTIAN
    for model in models:
        limit = 90.0 if model.theta_r_max_deg is None else model.theta_r_max_deg
        for wavelength in (own_wavelength(model, each) for each in np.atleast_1d(wavelength_nm)):
            f11 = disc.evaluate(model, wavelength, in_plane(theta_i_deg, phi_i_deg, theta_r_deg))[..., 0, 0]
            label = labels.title(labels.plain(model.name), wavelength)
            axes.plot(np.radians(theta_r_deg), f11, linewidth=1.4, label=label)
            largest = max(largest, f11[np.abs(theta_r_deg) <= limit].max())
    lambertian = np.full(theta_r_deg.shape, LAMBERTIAN)
    axes.plot(np.radians(theta_r_deg), lambertian, ":", color="0.4", linewidth=0.9, label=r"$1/\pi$ sr$^{-1}$")
    _finish_half_disc(axes, theta_i_deg, largest)
    return axes.figure, axes


def _finish_half_disc(axes: PolarAxes, theta_i_deg: float, largest: float) -> None:
    """The forward side on the right, ticks, labels, the incident light, and a legend below."""
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
    axes.set_xlabel(r"angle: $\theta_\mathrm{r}$;  radius: $f_{\mathrm{r},11}$ / sr$^{-1}$")
    axes.xaxis.set_label_coords(0.5, 0.2)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, 0.18), frameon=False, fontsize=8, ncol=3)


def _plane_axes(theta_r_max_deg: float | None, theta_r_deg, values) -> Axes:
    """Axes with labels and units for curves of the shape (4, angles), grey where the model was not fitted."""
    axes = labels.Picture(figsize=(6.4, 4.4), layout="constrained").add_subplot()
    axes.set(
        xlim=(-90, 90),
        xticks=range(-90, 91, 30),
        ylabel=r"$f_\mathrm{r}$ / sr$^{-1}$",
        xlabel=r"scattering polar angle $\theta_\mathrm{r}$ / °",
    )
    fitted = np.abs(theta_r_deg) <= (90 if theta_r_max_deg is None else theta_r_max_deg)
    if fitted.any():
        low, high = values[:, fitted].min(), values[:, fitted].max()
        axes.set_ylim(low - 0.15 * (high - low), high + 0.15 * (high - low))
    if theta_r_max_deg is not None:
        for sign in (-1, 1):
            axes.axvspan(sign * theta_r_max_deg, sign * 90, color="0.93", zorder=0, linewidth=0)
    return axes
