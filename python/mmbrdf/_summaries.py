# SPDX-License-Identifier: BSD-3-Clause
"""A few lines on what one holds: summary(), and what notebooks show of it."""

from __future__ import annotations

import html
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from . import _calls, _mmbrdf
from ._warnings import ExtrapolationWarning

Rows = Iterator[tuple[str, str]]

_MOST = 6
"""So many wavelengths are told apart."""


def with_u(value: float, u: float | None) -> str:
    """ "0.98412 ± 0.00032"; three digits where u is not known."""
    if u is None or not np.isfinite(u) or u <= 0:
        return f"{value:.3g}"
    return f"{_mmbrdf._to_place_of(value, u)} ± {_mmbrdf._to_place_of(u, u)}"


def _nm(wavelengths: Any) -> str:
    return ", ".join(f"{nm:.10g}" for nm in wavelengths) + " nm"


def _model(model: Any) -> Rows:
    printed = " as printed" if model.as_printed else ""
    yield "basis", f"{model.family}{printed}, orders {model.orders}, powers {model.powers}, {model.coefficient_count} coefficients"
    angles = [
        f"{name} to {most:.4g} degrees"
        for name, most in (("theta_i", model.theta_i_max_deg), ("theta_r", model.theta_r_max_deg))
        if most is not None
    ]
    at = [_nm(model.wavelengths_nm)] if model.wavelengths_nm else []
    yield "fitted", "; ".join([*at, ", ".join(angles)] if angles else at) or "not known where"
    if model.not_measured:
        yield "not measured", ", ".join(model.not_measured)
    for nm in model.wavelengths_nm[:_MOST]:
        yield from _reflectances(model, nm)
    if len(model.wavelengths_nm) > _MOST:
        yield "", f"and {len(model.wavelengths_nm) - _MOST} more wavelengths"
    kind = {"sample": "hold for the sample", "noise": "are those of the noise alone"}.get(
        model.provenance.get("uncertainty", ""), "are those of the fit"
    )
    yield "uncertainties", f"{kind} (k = 1)" if model.has_covariance else "not known"
    if "data" in model.provenance:
        yield "data", model.provenance["data"]


def _reflectances(model: Any, nm: float) -> Rows:
    """In one line; what cannot be had is left out."""
    known = {"uncertainty": True} if model.has_covariance else {}
    questions: list[tuple[str, Callable[[], Any]]] = [
        ("DHR(8)", lambda: _mmbrdf.directional_hemispherical_reflectance(model, nm, 8, **known)),
        ("0:45", lambda: model.reflectance_factor(nm, 0, 0, 45, 0, **known)),
    ]
    words = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ExtrapolationWarning)
        for name, ask in questions:
            try:
                found = ask()
            except ValueError:
                continue
            value, u = (found.value, found.u) if known else (found, None)
            words.append(f"{name} {with_u(float(value), None if u is None else float(u))}")
    if words:
        yield f"{nm:.10g} nm", ", ".join(words)


def _fit(result: Any) -> Rows:
    yield "fit", repr(result)[1:-1].partition(": ")[2]
    if result.model.provenance.get("weights") == "data":  # else the unit of chi^2 is nobody's
        yield "chi^2 / dof", ", ".join(
            f"{name} {value:.3g}" for name, value in list(result.chi_squared_per_dof.items())[:2]
        )
    told = _told_of_a_fit[0](result).splitlines()[1:]
    for line in told:
        if not line.startswith("warning: "):
            yield "sample", line
    yield from _model(result.model)
    for line in told:
        if line.startswith("warning: "):
            yield "warning", line.removeprefix("warning: ")


def _dataset(data: Any) -> Rows:
    yield "samples", f"{len(data)} at {_nm(data.wavelengths_nm)}" if len(data) else "none"
    if not len(data):
        return
    theta_i, theta_r = data.theta_i_deg, data.theta_r_deg
    yield "directions", f"theta_i {theta_i.min():.4g} to {theta_i.max():.4g}, theta_r {theta_r.min():.4g} to {theta_r.max():.4g} degrees"
    if (f11 := data.f11[~np.isnan(data.f11)]).size:
        yield "f11", f"{f11.min():.3g} to {f11.max():.3g} sr^-1, median {np.median(f11):.3g} sr^-1"
    frames, counts = np.unique(data.frame, return_counts=True)
    if frames.tolist() != ["xy"]:
        told = [f"{name} ({count} sample{'s' * (count != 1)})" for name, count in zip(frames, counts.tolist())]
        yield "frame", ", ".join(told) if len(told) > 1 else str(frames[0])
    missing = np.isnan(data.as_measured).mean(axis=0)
    names = [(i, j, f"{i + 1}{j + 1}") for i in range(4) for j in range(4)]
    never = [name for i, j, name in names if missing[i, j] == 1]
    sometimes = [name for i, j, name in names if 0 < missing[i, j] < 1]
    if never or sometimes:
        yield "not measured", ", ".join(never + [f"{name} in part" for name in sometimes])
    yield "uncertainties", _spread(data)
    for name, text in (("read as", data.read_as), ("reduction", data.reduction)):
        if text:
            yield name, text


def _spread(data: Any) -> str:
    if data.uncertainty is None:
        return "not known"
    with np.errstate(divide="ignore", invalid="ignore"):
        f11 = np.nanmedian(data.uncertainty[:, 0, 0] / data.f11)
    others = data.uncertainty.reshape(len(data), 16)[:, 1:]
    words = f"median {100 * f11:.2g} % of f11"
    return words + (f", {np.nanmedian(others):.2g} of the others" if np.isfinite(others).any() else "")


def _polarimeter(polarimeter: Any) -> Rows:
    pairs = "" if polarimeter.pairs is None else f", {len(polarimeter.pairs)} pairs"
    yield "states", f"{len(polarimeter.generator)} of the generator, {len(polarimeter.analyzer)} of the analyzer{pairs}"
    yield "determines", f"{polarimeter.rank} of 16 combinations of elements, condition number {polarimeter.condition:.3g}"


def _calibration(instrument: Any) -> Rows:
    yield "wavelength", f"{instrument.wavelength_nm:.10g} nm"
    yield from _polarimeter(instrument.polarimeter)
    kinds = ", ".join(f"{kind} {value:.2g}" for kind, value in instrument.figure_of_merit_by_kind.items())
    yield "figure of merit", f"{instrument.figure_of_merit:.2g}" + (f": {kinds}" if kinds else "")
    elements = instrument.figure_of_merit_by_element.ravel()
    worst = int(np.argmax(elements[1:])) + 1
    yield "worst element", f"{worst // 4 + 1}{worst % 4 + 1}, {elements[worst]:.2g}"
    yield "condition", f"generator {instrument.generator_condition:.3g}, analyzer {instrument.analyzer_condition:.3g}"
    if instrument.degrees_of_freedom > 0 and instrument.chi_squared > 0:
        yield "chi^2 / dof", f"{instrument.chi_squared / instrument.degrees_of_freedom:.3g}, {instrument.degrees_of_freedom} degrees of freedom"
    if instrument.generator_uncertainty is not None:
        most = max(instrument.generator_uncertainty.max(), (instrument.analyzer_uncertainty / _scale(instrument)).max())
        yield "u of the states", f"{most:.2g} at most, of an intensity of 1"
    if instrument.scale_uncertainty > 0:
        yield "u of the scale", f"{100 * instrument.scale_uncertainty:.2g} %"
    for name, (value, u) in (instrument.retarders or {}).items():
        yield name, with_u(value, u)
    for name in ("data", "references"):
        if name in instrument.provenance:
            yield name, instrument.provenance[name]


def _scale(instrument: Any) -> float:
    """Of the analyzer's states, which count in the units of the readings."""
    return float(np.abs(instrument.polarimeter.analyzer[:, 0]).mean()) or 1.0


_told_of_a_fit: list[Callable[[Any], str]] = []
"""What the compiled part says of a fit and its sample."""

_KINDS: dict[str, Callable[[Any], Rows]] = {
    "Model": _model,
    "FitResult": _fit,
    "Dataset": _dataset,
    "Polarimeter": _polarimeter,
    "Calibration": _calibration,
}


def _title(thing: Any) -> str:
    name = getattr(thing, "name", "")
    return f"mmbrdf.{type(thing).__name__}" + (f" '{name}'" if name else "")


def summary(self: Any) -> str:
    """What it is, in a few lines of text: values to two digits of their standard uncertainty, where that is known."""
    rows = list(_KINDS[type(self).__name__](self))
    width = max(len(name) for name, _ in rows)
    return "\n".join([_title(self), *(f"  {name:{width}}  {text}" for name, text in rows)])


def in_html(self: Any) -> str:
    """The same as a table, which notebooks show."""
    rows = "".join(
        f'<tr><th style="text-align:left">{html.escape(name)}</th><td style="text-align:left">{html.escape(text)}</td></tr>'
        for name, text in _KINDS[type(self).__name__](self)
    )
    return f"<table><caption>{html.escape(_title(self))}</caption><tbody>{rows}</tbody></table>"


def install(compiled: Any) -> None:
    """Gives the types of the compiled part summary(), and a look in notebooks."""
    _told_of_a_fit[:] = [compiled.FitResult.summary]
    for name in _KINDS:
        kind = getattr(compiled, name)
        kind.summary = _calls.told_in_a_line(f"{name}.summary", "mmbrdf._mmbrdf")(summary)
        kind.summary.__qualname__ = f"{name}.summary"  # where pickles look for it
        kind._repr_html_ = in_html
