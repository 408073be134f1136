# SPDX-License-Identifier: BSD-3-Clause
"""All sixteen elements side by side, as in Figs. 1-4 of Germer (2017)."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

import mmbrdf

from .._arguments import require

from . import disc, labels

if TYPE_CHECKING:
    from matplotlib.figure import Figure, SubFigure
    from numpy.typing import NDArray

    from mmbrdf import Dataset, Model

F11_LABEL = r"$f_{\mathrm{r},11}$ / sr$^{-1}$"
ELEMENT_LABEL = r"$m_{ij} = f_{\mathrm{r},ij}\,/\,f_{\mathrm{r},11}$"


def hemisphere(
    source: Model | Dataset,
    wavelength_nm: float | None,
    theta_i_deg: float,
    *,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    frame: str = "xy",
    samples: int = 201,
    f11_limits: tuple[float, float] = (0.25, 0.45),
    limit: float = 0.1,
    title: str | None = None,
    figure: Figure | SubFigure | None = None,
    decorated: bool = True,
) -> tuple[Figure | SubFigure, NDArray]:
    """The Mueller-matrix BRDF over the hemisphere at one direction of incidence.

    ``source`` is a model, evaluated at ``samples`` x ``samples`` places, or a data set, each of whose samples at this
    wavelength (nm) and direction of incidence (degrees) is a cell. Element 11 is in sr^-1, from black to white over
    ``f11_limits``; the others are divided by it, from blue over white to red over -``limit`` ... ``limit``. What lies
    beyond has the colour of the end. A dashed circle shows how far the model was fitted. Without a ``title`` it names
    the model, or says that it was measured.

    Returns the figure and its axes, 4 x 4. With ``decorated=False`` there are only the discs, for use in a
    ``figure`` or subfigure with many of them. ValueError if a data set has no such samples.
    """
    wavelength_nm, theta_i_deg = disc.question(source, wavelength_nm, theta_i_deg)
    image = disc.matrices(source, wavelength_nm, theta_i_deg, phi_i_deg, frame, samples)
    image = image._replace(values=disc.normalized(image.values))
    scales = ("gray", Normalize(*f11_limits)), ("RdBu_r", Normalize(-limit, limit))
    figure, axes = _matrix_of_discs(image, scales, figure, decorated)
    if decorated:
        kind = "measured" if isinstance(source, mmbrdf.Dataset) else labels.plain(source.name)
        title = labels.title(kind, wavelength_nm, theta_i_deg) if title is None else title
        _decorate(figure, axes, scales, (F11_LABEL, ELEMENT_LABEL), title)
        for each in axes.flat:
            disc.mark_limit(each, getattr(source, "theta_r_max_deg", None))
    return figure, axes


def residual_map(
    model: Model,
    data: Dataset,
    wavelength_nm: float | None,
    theta_i_deg: float,
    *,
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    f11_limit: float = 0.02,
    limit: float = 0.05,
    title: str | None = None,
    figure: Figure | SubFigure | None = None,
    decorated: bool = True,
) -> tuple[Figure | SubFigure, NDArray]:
    """Measured minus model at the samples of one wavelength (nm) and direction of incidence (degrees).

    Element 11 in sr^-1 over -``f11_limit`` ... ``f11_limit``, the others divided by f11 over -``limit`` ... ``limit``.
    Returns the figure and its axes, 4 x 4. ValueError if the data set has no such samples.
    """
    require("model", model, mmbrdf.Model)
    require("data", data, mmbrdf.Dataset)
    wavelength_nm, theta_i_deg = disc.question(data, wavelength_nm, theta_i_deg)
    chosen = disc.samples_at(data, wavelength_nm, theta_i_deg, phi_i_deg)
    x, y = disc.direction_cosines(chosen.theta_r_deg, chosen.phi_r_deg)
    image = disc.cells(x, y, mmbrdf.residuals(model, chosen))
    scales = ("PuOr_r", Normalize(-f11_limit, f11_limit)), ("RdBu_r", Normalize(-limit, limit))
    figure, axes = _matrix_of_discs(image, scales, figure, decorated)
    if decorated:
        names = r"residual of $f_{\mathrm{r},11}$ / sr$^{-1}$", "residual of $m_{ij}$"
        title = (
            labels.title(f"measured $-$ {labels.plain(model.name)}", wavelength_nm, theta_i_deg)
            if title is None
            else title
        )
        _decorate(figure, axes, scales, names, title)
    return figure, axes


def _matrix_of_discs(image: disc.DiscImage, scales, figure, decorated: bool):
    """4 x 4 discs of values (rows, columns, 4, 4); the first of the two scales, (map, norm), is that of element 11."""
    if figure is None:
        figure = labels.Picture(figsize=(6.6, 6.0) if decorated else (4, 4))
    space = (
        dict(left=0.085, right=0.83, bottom=0.085, top=0.93)
        if decorated
        else dict(left=0.025, right=0.975, bottom=0.025, top=0.975)
    )
    axes = figure.subplots(4, 4, gridspec_kw=dict(wspace=0.04, hspace=0.04, **space))
    for row, column in np.ndindex(4, 4):
        cmap, norm = scales[0] if row == column == 0 else scales[1]
        disc.draw(axes[row, column], image.values[..., row, column], image.extent, cmap, norm)
    return figure, axes


def _decorate(figure, axes, scales, names, title: str) -> None:
    """Names of the elements, the two colour scales, the coordinates and a title."""
    for row, column in np.ndindex(4, 4):
        axes[row, column].text(-1, 0.98, f"{row + 1}{column + 1}", fontsize=8, ha="left", va="top")
    axes[3, 0].set(xticks=[-1, 0, 1], yticks=[-1, 0, 1])
    axes[3, 0].tick_params(labelsize=7, length=2)
    left, right = (axes[0, column].get_position() for column in (0, 3))
    lowest = axes[3, 0].get_position()
    middle = (left.x0 + right.x1) / 2, (lowest.y0 + left.y1) / 2
    figure.text(middle[0], lowest.y0 - 0.05, disc.X_LABEL, ha="center", va="top", fontsize=9)
    figure.text(left.x0 - 0.05, middle[1], disc.Y_LABEL, ha="right", va="center", rotation=90, fontsize=9)
    figure.text(middle[0], left.y1 + 0.02, title, ha="center", va="bottom", fontsize=11)
    heights = (middle[1] + 0.03, left.y1 - middle[1] - 0.03), (lowest.y0, middle[1] - lowest.y0 - 0.03)
    for (cmap, norm), label, (bottom, height) in zip(scales, names, heights):
        place = figure.add_axes((right.x1 + 0.03, bottom, 0.022, height))
        bar = figure.colorbar(ScalarMappable(norm, cmap), cax=place, extend="both")
        bar.set_label(label, fontsize=9)
        bar.ax.tick_params(labelsize=7)
