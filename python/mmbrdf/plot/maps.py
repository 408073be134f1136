# SPDX-License-Identifier: BSD-3-Clause
"""One number derived from the Mueller matrix, over the hemisphere of detection."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Normalize

import mmbrdf

from .._arguments import require_measured
from . import disc, labels

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mmbrdf import Dataset, Model

DEPOLARIZATION_LABEL = "Gil–Bernabeu depolarization parameter"
MARGIN_LABEL = r"smallest coherency eigenvalue $/\,f_{\mathrm{r},11}$"
UNREALIZABLE = "#d62728"


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
) -> tuple[Figure, Axes]:
    """Gil and Bernabeu's depolarization parameter over the hemisphere (Fig. 5 of Germer 2017).

    0 where the light is depolarized completely, 1 where not at all. ``source`` is a model or a data set (of which noise
    makes the parameter too large), the wavelength is in nm, angles are in degrees. ``limits`` are the ends of the
    colour scale; without them it spans what the disc has within the fitted range. Where f11 is not positive, as models
    may have it near grazing angles, there is none. Returns the figure and its axes.
    """
    require_measured(source)
    wavelength_nm, theta_i_deg = disc.question(source, wavelength_nm, theta_i_deg)
    image = disc.matrices(source, wavelength_nm, theta_i_deg, phi_i_deg, "xy", samples)
    values = _where_positive(image.values, mmbrdf.depolarization)
    if limits is None:
        limits = _limits_within(image, values, getattr(source, "theta_r_max_deg", None))
    return _draw_map(
        source,
        image._replace(values=values),
        "viridis",
        Normalize(*limits),
        DEPOLARIZATION_LABEL,
        labels.title("", wavelength_nm, theta_i_deg),
        axes,
        colorbar,
        "both",
    )


def realizability_map(
    source: Model | Dataset,
    wavelength_nm: float | None,
    theta_i_deg: float,
    *,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    samples: int = 201,
    axes: Axes | None = None,
    colorbar: bool = True,
) -> tuple[Figure, Axes]:
    """How far the Mueller matrices are from those that no scatterer can have.

    The smallest eigenvalue of the coherency matrix divided by f11: 1/4 for a perfect depolarizer, 0 at the edge.
    Directions are red where it or f11 is negative. Wavelength in nm, angles in degrees. Returns the figure and its
    axes.
    """
    require_measured(source)
    wavelength_nm, theta_i_deg = disc.question(source, wavelength_nm, theta_i_deg)
    image = disc.matrices(source, wavelength_nm, theta_i_deg, phi_i_deg, "xy", samples)
    values = _where_positive(image.values, mmbrdf.realizability_margin)
    values[image.values[..., 0, 0] <= 0] = -1  # as bad as can be: the light would be less than none
    cmap = colormaps["cividis"].with_extremes(under=UNREALIZABLE)
    return _draw_map(
        source,
        image._replace(values=values),
        cmap,
        Normalize(0, 0.25),
        MARGIN_LABEL,
        labels.title("", wavelength_nm, theta_i_deg),
        axes,
        colorbar,
        "min",
    )


def _where_positive(mueller, quantity):
    """A quantity of matrices (rows, columns, 4, 4) that divides by f11, not a number where f11 is not positive."""
    positive = mueller[..., 0, 0] > 0
    values = np.full(positive.shape, np.nan)
    values[positive] = quantity(mueller[positive])
    return values


def _limits_within(image: disc.DiscImage, values, theta_r_max_deg: float | None) -> tuple[float, float]:
    """Smallest and largest value among the directions that were fitted."""
    edge = 1.0 if theta_r_max_deg is None else np.sin(np.radians(theta_r_max_deg))
    inside = values[(np.hypot(*image.centres()) <= edge) & np.isfinite(values)]
    return float(inside.min()), float(inside.max())


def _draw_map(source, image: disc.DiscImage, cmap, norm, label: str, title: str, axes, colorbar: bool, extend: str):
    if axes is None:
        axes = labels.Picture(figsize=(4.6, 3.7), layout="constrained").add_subplot()
    figure = axes.figure
    drawn = disc.draw(axes, image.values, image.extent, cmap, norm, label_axes=True)
    disc.mark_limit(axes, getattr(source, "theta_r_max_deg", None))
    axes.set_title(title)
    if colorbar:
        figure.colorbar(drawn, ax=axes, extend=extend, label=label)
    return figure, axes
