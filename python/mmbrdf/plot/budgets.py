# SPDX-License-Identifier: BSD-3-Clause
"""What an uncertainty is made of, and what a sample is besides an isotropic one."""
from __future__ import annotations

import json
import warnings
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.patches import Patch

import mmbrdf

from .._arguments import number, own_wavelength, require, unmasked
from . import disc, labels, sizes
from .colours import series
from .curves import ANGLE_LABEL, grey_beyond, in_plane, mark_plane
from .scalars import SYMBOLS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from mmbrdf import FitResult, Model

HATCHES = ("", "////", "....", "\\\\\\\\", "xxxx", "----")


@sizes.sized
def uncertainty_parts(
    model: Model,
    wavelength_nm: float | None,
    theta_i_deg: float | Sequence[float] | None = None,
    *,
    quantity: str = "f11",
    phi_i_deg: float = disc.SOURCE_AZIMUTH_DEG,
    theta_r_deg: Sequence[float] | None = None,
    terms: dict[str, float] | None = None,
    relative: bool = False,
    axes: Axes | None = None,
    width_cm: float | None = None,
) -> tuple[Figure, Axes]:
    """The standard uncertainty of a quantity by cause, stacked: squares add up, so each has its share of u^2 of the height u.

    Of f11, or another name of ``mmbrdf.quantities()``, against the signed polar angle of detection in the plane of incidence
    at ``theta_i_deg`` (45), as in ``in_plane_curves``; of "dhr", the directional-hemispherical reflectance, against the angle
    of incidence, ``theta_i_deg`` being those to draw. ``terms`` of type B are causes, too. ``relative`` divides by the value, in
    percent. The upper edge is u, k = 1. Returns the figure and its axes; the bodies are in the order of the legend.
    ValueError for a model without a covariance.
    """
    require("model", model, mmbrdf.Model)
    if not model.has_covariance:
        raise ValueError("the model has no covariance: fit it, or take one that keeps it")
    wavelength_nm = own_wavelength(model, wavelength_nm)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mmbrdf.ExtrapolationWarning)
        if quantity == "dhr":
            parts = _of_dhr(model, wavelength_nm, theta_i_deg, phi_i_deg, terms)
        else:
            incident = number("theta_i_deg", 45.0 if theta_i_deg is None else theta_i_deg)
            parts = _in_plane(model, wavelength_nm, incident, phi_i_deg, theta_r_deg, quantity, terms)
    axes = _stack(axes, width_cm, parts, relative)
    span = parts.angles.min(), parts.angles.max()
    if quantity == "dhr":
        axes.set(xlabel=r"angle of incidence $\theta_\mathrm{i}$ / °", xlim=span)
        grey_beyond(axes, parts.limit, span[1], both=False)
    else:
        axes.set(xlabel=ANGLE_LABEL, xlim=span)
        grey_beyond(axes, parts.limit, max(-span[0], span[1]))
        mark_plane(axes, incident)
    axes.set_ylabel(_label(quantity, relative))
    at = None if quantity == "dhr" else incident
    axes.set_title(labels.title(labels.plain(model.name), wavelength_nm, at, source=model))
    return axes.figure, axes


class Parts(NamedTuple):
    """A value and its standard uncertainty by cause at some angles, of which those up to the limit were fitted."""

    angles: NDArray[np.float64]
    value: NDArray[np.float64]
    by_cause: dict[str, NDArray[np.float64]]
    limit: float | None


def _of_dhr(model: Model, wavelength_nm, theta_i_deg, phi_i_deg: float, terms) -> Parts:
    angles = (
        np.arange(0.0, 86.0, 2.5)
        if theta_i_deg is None
        else np.atleast_1d(np.asarray(unmasked("theta_i_deg", theta_i_deg), float))
    )
    where = wavelength_nm, angles, phi_i_deg
    value = np.asarray(mmbrdf.directional_hemispherical_reflectance(model, *where))
    parts = mmbrdf.directional_hemispherical_uncertainty(model, *where, terms=terms, by_term=True)
    return Parts(angles, value, _spread(parts, angles), model.theta_i_max_deg)


def _in_plane(model: Model, wavelength_nm, theta_i_deg: float, phi_i_deg: float, theta_r_deg, quantity, terms) -> Parts:
    angles = (
        np.arange(-85.0, 86.0, 2.5) if theta_r_deg is None else np.asarray(unmasked("theta_r_deg", theta_r_deg), float)
    )
    # The intensity that unpolarized light of intensity 1 leaves behind is f11.
    where = in_plane(theta_i_deg, phi_i_deg, angles)
    found = model.analyze(wavelength_nm, *where, terms=terms, stokes=[1, 0, 0, 0])
    found = {"f11": found["scattered_S1"]} | {name: found[name] for name in _without_light(found)}
    if quantity not in found:
        raise ValueError(f"quantity = {quantity!r}: expected one of dhr, {', '.join(found)}")
    asked = found[quantity]
    return Parts(angles, asked.value, _spread(asked.parts, angles), model.theta_r_max_deg)


def _spread(parts: dict[str, Any], angles) -> dict[str, NDArray[np.float64]]:
    return {name: np.abs(np.broadcast_to(part, angles.shape)) for name, part in parts.items()}


def _label(quantity: str, relative: bool) -> str:
    symbol = {"f11": r"$f_{\mathrm{r},11}$", "dhr": "DHR"}.get(
        quantity, SYMBOLS.get(quantity, quantity.replace("_", " "))
    )
    if relative:
        return f"relative standard uncertainty\nof {symbol} / %"
    unit = "sr^-1" if quantity == "f11" else {q.name: q.unit for q in mmbrdf.quantities()}.get(quantity, "")
    return labels.quantity(f"standard uncertainty\nof {symbol}", unit)


def _without_light(names: Iterable[str]) -> list[str]:
    taken = {quantity.name for quantity in mmbrdf.quantities() if quantity.takes_light}
    return [name for name in names if name not in taken]


CAUSES = {"posterior": "sample and noise", "projection": "end of the basis", "fit": "noise of the fit"}
"""What the names of a model's own parts mean, for a legend."""


def _stack(axes, width_cm, parts: Parts, relative: bool) -> Axes:
    axes = sizes.figure(width_cm, 6.0, 4.6, layout="constrained").add_subplot() if axes is None else axes
    angles, bodies, limit = parts.angles, parts.by_cause, parts.limit
    unit = 100 / np.abs(parts.value) if relative else np.ones(angles.shape)
    square = np.sum([body**2 for body in bodies.values()], axis=0)
    total = np.sqrt(square)
    strokes = series(len(bodies), [labels.plain(CAUSES.get(name, name.replace("_", " "))) for name in bodies])
    below, handles = np.zeros(angles.shape), []
    for number_, (stroke, body) in enumerate(zip(strokes, bodies.values())):
        share = np.divide(body**2, total, out=np.zeros_like(total), where=total > 0) * unit
        hatch = HATCHES[number_ % len(HATCHES)]
        face = dict(facecolor=stroke.color, edgecolor="white", hatch=hatch, linewidth=0.4)
        axes.fill_between(angles, below, below + share, **face, zorder=1)
        handles.append(Patch(label=stroke.label if share.any() else f"{stroke.label}: none", **face))
        below = below + share
    axes.plot(angles, total * unit, color="black", linewidth=1.2, zorder=2, label="u")
    inside = np.abs(angles) <= (np.inf if limit is None else limit)
    axes.set_ylim(0, 1.1 * float(np.nanmax((total * unit)[inside if inside.any() else slice(None)])))
    sizes.legend_below(axes, handles[::-1], "height $u$ ($k$ = 1), shares of $u^2$")
    return axes


@sizes.sized
def anisotropy(
    source: FitResult | Model,
    wavelength_nm: float | None = None,
    *,
    axes: Axes | None = None,
    width_cm: float | None = None,
) -> tuple[Figure, Axes]:
    """What a fit of uncertainty="sample" has found of its sample, block after block of elements.

    Standard deviations over directions: of the anisotropy once, twice and three times per turn of the sample, of what is not
    reciprocal, and of the noise of one reading at normal directions; of block 11 in sr^-1, of others as they are divided by f11.
    ``wavelength_nm`` is one of the fit, the first without it. Returns the figure and its axes. ValueError for a model whose fit
    did not look at it.
    """
    model = source.model if isinstance(source, mmbrdf.FitResult) else source
    require("source", model, mmbrdf.Model)
    facts = json.loads(mmbrdf.report_json(model, "", None if not model.wavelengths_nm else list(model.wavelengths_nm)))
    rows = facts.get("sample") or []
    if not rows:
        raise ValueError("the model says nothing of its sample: fit it with uncertainty='sample'")
    known = sorted({row["wavelength_nm"] for row in rows})
    nm = known[0] if wavelength_nm is None else number("wavelength_nm", wavelength_nm)
    rows = [row for row in rows if np.isclose(row["wavelength_nm"], nm, rtol=1e-6)]
    if not rows:
        raise ValueError(f"wavelength_nm = {nm:g}: the fit was at {', '.join(f'{each:g}' for each in known)} nm")
    axes = sizes.figure(width_cm, 6.0, 5.4, layout="constrained").add_subplot() if axes is None else axes
    kinds = {name: label for name, label in TRAITS.items() if any(isinstance(row.get(name), float) for row in rows)}
    strokes = series(len(kinds), list(kinds.values()))
    for number_, (name, stroke) in enumerate(zip(kinds, strokes)):
        at = np.arange(len(rows)) + 0.14 * (number_ - (len(kinds) - 1) / 2)
        values = np.array([row.get(name) or np.nan for row in rows], float)
        axes.plot(at, values, stroke.marker, color=stroke.color, markersize=5, label=stroke.label, markeredgewidth=1.0,
                  markerfacecolor=stroke.color if number_ % 2 == 0 else "white")  # fmt: skip
    axes.set(
        yscale="log",
        xlim=(-0.6, len(rows) - 0.4),
        xlabel="block of elements; 11 in sr$^{-1}$",
        ylabel="standard deviation",
    )
    axes.set_xticks(range(len(rows)), [str(row["block"]).replace(",", "\n") for row in rows])
    axes.grid(axis="y", color="0.92", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.set_title(labels.title(labels.plain(model.name), nm))
    zeros = any(row.get(name) == 0 for row in rows for name in kinds)
    lines = max(str(row["block"]).count(",") for row in rows) + 1
    words = "what is 0 is not shown" if zeros else None
    sizes.legend_below(axes, axes.get_legend_handles_labels()[0], words, ems=2.0 + 1.2 * lines)
    return axes.figure, axes


TRAITS = {
    "once_per_turn": "once per turn",
    "twice_per_turn": "twice per turn",
    "thrice_per_turn": "three times per turn",
    "nonreciprocal": "not reciprocal",
    "noise": "noise of a reading",
}
