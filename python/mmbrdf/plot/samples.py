# SPDX-License-Identifier: BSD-3-Clause
"""Samples before there is a model: where they were measured, and which of them stand out."""
from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.colors import LogNorm, Normalize
from matplotlib.patches import Circle, Wedge

import mmbrdf

from .._arguments import own_wavelength, require
from . import disc, labels, sizes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure
    from numpy.typing import NDArray

    from mmbrdf import Dataset, Inspection

COUNTS = "cividis_r"
"""Light to dark, so that grey prints tell the same."""

SMALL = 6.5
"""Of notes beside small discs, in points."""

_SAME_DEG = 0.2
"""Directions closer than this are one point."""

MOST_MISSING, ALL_MISSING = 0.5, 0.95
"""Shares of the pairs of directions from which on a detector, or a source, is hatched."""

SUSPICIOUS = "#b03a00"
_MARKS = "xD^sv+"
_HOLE = {"facecolor": "none", "edgecolor": SUSPICIOUS, "linewidth": 0, "hatch": "////", "zorder": 1}


@sizes.sized
def directions(
    data: Dataset,
    wavelength_nm: float | None = None,
    *,
    inspection: Inspection | None = None,
    figure: Figure | SubFigure | None = None,
    width_cm: float | None = None,
) -> tuple[Figure | SubFigure, NDArray]:
    """Where the samples of one wavelength (nm) were measured, in projected direction cosines.

    The left disc has the directions of the source, at the azimuths that the samples have: it shows whether the sample
    was turned. The right one has those of the detector, with the source on the left: of an isotropic sample only the
    azimuth between both counts, and forward scattering is on the right. A point is the larger and the darker the more
    samples have this direction. Circles are polar angles of 30, 60 and 90 degrees. Hatched is the hole: detectors that more
    than half of the sources lack, to five degrees and on both sides of the plane of incidence, and polar angles without a
    source. What ``Inspection.hole`` says of it is written below.

    ``inspection`` is ``mmbrdf.inspect()`` of these samples, if that is known already. Returns the figure and its two axes.
    ValueError if there are no such samples.
    """
    require("data", data, mmbrdf.Dataset)
    if inspection is not None:
        require("inspection", inspection, mmbrdf.Inspection)
    wavelength_nm = own_wavelength(data, wavelength_nm)
    here = data.at_wavelengths(wavelength_nm)
    seen = mmbrdf.inspect(here) if inspection is None else inspection
    figure = sizes.figure(width_cm, 4.6, 3.3) if figure is None else figure
    axes = figure.subplots(1, 2, gridspec_kw=dict(left=0.02, right=0.98, bottom=0.3, top=0.9, wspace=0.06))
    relative = here.phi_r_deg - here.phi_i_deg + disc.SOURCE_AZIMUTH_DEG
    places = [_places(here.theta_i_deg, here.phi_i_deg), _places(here.theta_r_deg, relative)]
    most = max(2, *(counts.max() for _, _, counts in places))
    for each, (x, y, counts), name in zip(axes, places, ("source", "detector")):
        _circles(each)
        points = each.scatter(x, y, 5 + 25 * np.log(counts) / np.log(most), counts, cmap=COUNTS, norm=LogNorm(1, most))
        points.set(edgecolor="0.15", linewidth=0.3, zorder=3)
        each.set_title(f"{name}: {len(x)} direction{'s' * (len(x) > 1)}")
    _mark_hole(*axes, seen.missing)
    axes[0].text(-1.02, -1.02, r"$\phi_\mathrm{i}$ = 0 is on the right", fontsize=SMALL, va="top")
    axes[1].text(-1.02, -1.02, "towards the source", fontsize=SMALL, va="top")
    axes[1].text(1.02, -1.02, "forward", fontsize=SMALL, va="top", ha="right")
    _count_bar(figure, points, most)
    words = (seen.hole or f"covered: {seen.rows['covered']}").replace("phi_r - phi_i", "phi_r\u00a0-\u00a0phi_i")
    figure.text(
        0.02, 0.115, textwrap.fill(words, int(92 * figure.bbox.width / figure.dpi / 4.6)), fontsize=SMALL, va="top"
    )
    return figure, axes


def _places(theta_deg, phi_deg) -> tuple[NDArray, NDArray, NDArray]:
    """x and y of directions that differ, and how many samples have each."""
    x, y = disc.direction_cosines(theta_deg, phi_deg)
    cells = np.round(np.column_stack([x, y]) / np.radians(_SAME_DEG)).astype(int)
    _, first, counts = np.unique(cells, axis=0, return_index=True, return_counts=True)
    return x[first], y[first], counts


def _circles(axes: Axes) -> None:
    """The disc with its rim and its degrees."""
    axes.add_patch(Circle((0, 0), 1, facecolor="0.97", edgecolor="0.35", linewidth=0.7, zorder=0))
    for theta_deg in (30, 60):
        radius = np.sin(np.radians(theta_deg))
        axes.add_patch(Circle((0, 0), radius, facecolor="none", edgecolor="0.65", linewidth=0.5, zorder=2))
    box = dict(facecolor="white", edgecolor="none", alpha=0.75, pad=0.4)
    for theta_deg in (30, 60, 90):
        x, y = disc.direction_cosines(theta_deg, 68)
        axes.text(x, y, f"{theta_deg}°", fontsize=SMALL, ha="center", va="center", bbox=box, zorder=4)
    axes.set(xlim=(-1.05, 1.05), ylim=(-1.05, 1.05), aspect="equal", xticks=[], yticks=[])
    axes.spines[:].set_visible(False)


def _mark_hole(source: Axes, detector: Axes, missing: mmbrdf.Missing) -> None:
    """Hatches polar angles from which there was no light, and detectors that most sources lack."""
    if len(missing.theta_deg) == 0:
        return
    step = missing.theta_deg[1] - missing.theta_deg[0]
    for theta_deg in missing.theta_deg[missing.theta_i > ALL_MISSING]:
        inner, outer = np.sin(np.radians(np.clip([theta_deg - step / 2, theta_deg + step / 2], 0, 90)))
        source.add_patch(Wedge((0, 0), outer, 0, 360, width=outer - inner, **_HOLE))
    phi_deg = np.concatenate([-missing.phi_deg[:0:-1], missing.phi_deg]) + disc.SOURCE_AZIMUTH_DEG
    share = np.concatenate([missing.detector[:, :0:-1], missing.detector], axis=1)
    x, y = disc.direction_cosines(missing.theta_deg[:, None], phi_deg)
    known = np.ma.masked_invalid(share)
    if (known > MOST_MISSING).any():
        hatched = detector.contourf(x, y, known, [MOST_MISSING, 2], colors="none", hatches=["////"], zorder=1)
        for each in getattr(hatched, "collections", [hatched]):
            each.set(edgecolor=SUSPICIOUS, linewidth=0)
        if (known < MOST_MISSING).any():
            detector.contour(x, y, known, [MOST_MISSING], colors=SUSPICIOUS, linewidths=0.8, zorder=1)


def _count_bar(figure, points, most: int) -> None:
    bar = figure.colorbar(points, cax=figure.add_axes((0.3, 0.2, 0.4, 0.022)), orientation="horizontal")
    ticks = np.unique(np.round(np.geomspace(1, most, 4)).astype(int))
    bar.ax.minorticks_off()
    bar.set_ticks(ticks, labels=[str(tick) for tick in ticks])
    bar.ax.tick_params(labelsize=SMALL, length=2, pad=1.5)
    bar.ax.set_ylabel("samples ", fontsize=SMALL, rotation=0, ha="right", va="center")


@sizes.sized
def suspicious(
    data: Dataset,
    wavelength_nm: float | None = None,
    *,
    inspection: Inspection | None = None,
    axes: Axes | None = None,
    width_cm: float | None = None,
) -> tuple[Figure | SubFigure, Axes]:
    """f11 of the samples of one wavelength (nm) against theta_r, with a mark for those that a finding names.

    ``theta_r`` is positive where the detector is on the forward side of the source, and the colour is theta_i. The
    scale is that of the samples without a mark: others may be at its ends, as triangles. ``inspection`` is
    ``mmbrdf.inspect(data)``, if that is known already. Returns the figure and its axes.
    """
    return _against_theta_r(data, wavelength_nm, inspection, axes, width_cm, _f11, r"$f_{\mathrm{r},11}$ / sr$^{-1}$")


@sizes.sized
def low_order_residuals(
    data: Dataset,
    wavelength_nm: float | None = None,
    *,
    inspection: Inspection | None = None,
    axes: Axes | None = None,
    width_cm: float | None = None,
) -> tuple[Figure | SubFigure, Axes]:
    """The same of what a fit of low order leaves of f11, in percent of its root mean square: noise, fine structure, faults.

    Only the wavelength of the first sample has such a fit: ValueError for another. Where none can be made nothing is drawn.
    """
    require("data", data, mmbrdf.Dataset)
    seen = mmbrdf.inspect(data) if inspection is None else inspection
    name = "f11 less a fit of low order / %"
    figure, axes = _against_theta_r(data, _of_low_order(data, wavelength_nm), seen, axes, width_cm, _residuals, name)
    axes.axhline(0, color="0.3", linewidth=0.6, zorder=0)
    return figure, axes


def _of_low_order(data: Dataset, wavelength_nm: float | None) -> float | None:
    """The wavelength that has a fit of low order."""
    if len(data) == 0 or not np.isfinite(data.wavelength_nm[0]):
        return wavelength_nm
    first = float(data.wavelength_nm[0])
    if wavelength_nm is not None and not np.isclose(wavelength_nm, first, rtol=1e-6):
        raise ValueError(
            f"no fit of low order at {wavelength_nm:g} nm: it is at {first:g} nm, that of the first sample"
        )
    return first


def _f11(data: Dataset, seen: Inspection) -> NDArray:
    return data.f11


def _residuals(data: Dataset, seen: Inspection) -> NDArray:
    known = np.isfinite(seen.residuals) & np.isfinite(data.f11)
    size = np.sqrt(np.mean(data.f11[known] ** 2)) if known.any() else 1.0
    return 100 * seen.residuals / (size or 1.0)


def _against_theta_r(
    data, wavelength_nm, inspection, axes, width_cm, values_of, name
) -> tuple[Figure | SubFigure, Axes]:
    require("data", data, mmbrdf.Dataset)
    if inspection is not None:
        require("inspection", inspection, mmbrdf.Inspection)
    seen = mmbrdf.inspect(data) if inspection is None else inspection
    wavelength_nm = own_wavelength(data, wavelength_nm)
    here = np.isclose(data.wavelength_nm, wavelength_nm, rtol=1e-6)
    if not here.any():
        raise ValueError(f"no samples at {wavelength_nm:g} nm")
    if axes is None:
        axes = sizes.figure(width_cm, 4.6, 3.2, layout="constrained").add_subplot()
    forward = np.cos(np.radians(data.phi_r_deg - data.phi_i_deg)) <= 1e-6
    angle, values = np.where(forward, 1, -1) * data.theta_r_deg, values_of(data, seen)
    named = {one.fault: np.isin(np.arange(len(data)), one.samples) & here for one in seen.findings if one.samples}
    named = {fault: which for fault, which in named.items() if which.any()}
    plain = here & ~np.any(list(named.values()), axis=0) if named else here
    plain &= np.isfinite(values)
    points = axes.scatter(angle[plain], values[plain], 7, data.theta_i_deg[plain], cmap=COUNTS, norm=Normalize(0, 90))
    points.set(edgecolor="0.3", linewidth=0.2)
    low, high = _limits(values[plain] if plain.any() else values[here])
    for (fault, which), mark in zip(named.items(), _MARKS):
        _mark(axes, angle[which], values[which], (low, high), mark, fault)
    axes.set(ylim=(low, high), xlabel=r"$\theta_\mathrm{r}$, forward positive / °", ylabel=name)
    axes.grid(color="0.92", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.figure.colorbar(points, ax=axes, label=r"$\theta_\mathrm{i}$ / °", ticks=[0, 30, 60, 90])
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="best", framealpha=0.85)
    return axes.figure, axes


def _limits(values: NDArray) -> tuple[float, float]:
    values = values[np.isfinite(values)]
    if len(values) == 0:
        return -1.0, 1.0
    margin = 0.06 * np.ptp(values) or 0.1 * abs(values[0]) or 1.0
    return float(values.min() - margin), float(values.max() + margin)


def _mark(axes: Axes, angle, values, limits: tuple[float, float], mark: str, fault: str) -> None:
    """Samples that a finding names; those without a value are left out, those beyond the limits are at them."""
    inside = (values >= limits[0]) & (values <= limits[1])
    label, used = labels.plain(f"{fault}: {len(values)}"), inside.any()
    colours = {"color": SUSPICIOUS} if mark in "x+" else {"facecolors": "none", "edgecolors": SUSPICIOUS}
    if used:
        axes.scatter(angle[inside], values[inside], 32, marker=mark, linewidth=1.1, label=label, zorder=4, **colours)
    for beyond, place, arrow in ((values < limits[0], limits[0], "v"), (values > limits[1], limits[1], "^")):
        if beyond.any():
            shown = axes.scatter(
                angle[beyond], np.full(beyond.sum(), place), 32, SUSPICIOUS, arrow, clip_on=False, zorder=5
            )
            shown.set_label(None if used else label)
            used = True
