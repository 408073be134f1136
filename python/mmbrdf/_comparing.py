# SPDX-License-Identifier: BSD-3-Clause
"""compare() of what `mmbrdf compare` compares: within the fitted ranges, unless it is said how far."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from . import _calls
from ._arguments import number
from ._results import Outside
from ._warnings import warn

_BEYOND = Outside.THETA_I | Outside.THETA_R | Outside.DIRECTIONS
_EXTRAPOLATED = _BEYOND | Outside.WAVELENGTH
_ROUNDING_DEG = 1e-7  # files give degrees

_MORE = """
theta_max_deg  only where both polar angles are at most this; None: without what lies beyond the angles to which a model was
               fitted at the wavelength, with an ExtrapolationWarning of samples that are left out. A geometry that is given
               is taken as it is. Of what is compared beyond the fit is warned, too"""


def _beyond(model: Any, wavelength_nm: Any, geometry: Any, ranges: Outside = _BEYOND) -> np.ndarray:
    """Which directions are beyond those that were fitted at the wavelength."""
    return (np.atleast_1d(model.outside(wavelength_nm, *geometry)) & int(ranges)) != 0


def _warn_of_extrapolation(model: Any, wavelength_nm: Any, geometry: Any) -> None:
    """If the model is asked beyond its fit."""
    found = np.atleast_1d(model.outside(wavelength_nm, *geometry)) & int(_EXTRAPOLATED)
    count = np.count_nonzero(found)
    if count == 0:
        return
    reasons = "+".join(str(flag.name).lower() for flag in Outside if (found & int(flag)).any())
    lie = "lies" if count == 1 else "lie"
    warn(
        f"{model.name}: {count} of {found.size} samples {lie} outside the fitted range ({reasons})",
        "ExtrapolationWarning",
    )


def _within(geometry: Any, theta_max_deg: float) -> np.ndarray:
    return np.maximum(np.abs(geometry.theta_i_deg), np.abs(geometry.theta_r_deg)) <= theta_max_deg + _ROUNDING_DEG


def _require_some(kept: np.ndarray, theta_max_deg: float | None) -> None:
    if kept.any():
        return
    if theta_max_deg is None:
        raise ValueError("no direction is within the fitted ranges of both: give theta_max_deg")
    raise ValueError(f"theta_max_deg = {theta_max_deg:g}: no geometry is within")


def _require_common(one: Any, other: Any) -> None:
    """Raises ValueError for samples at other wavelengths, whose fits cannot be compared."""

    def has(nm: float) -> bool:
        try:
            return len(one.at_wavelengths(nm)) > 0
        except ValueError:
            return False

    if not any(map(has, other.wavelengths_nm)):
        said = " and ".join(", ".join(f"{nm:.10g}" for nm in data.wavelengths_nm) + " nm" for data in (one, other))
        raise ValueError(f"the samples have no wavelength in common: they are at {said}")


def _of_samples(model: Any, data: Any, theta_max_deg: float | None) -> Any:
    """Those that are compared with a model."""
    geometry = data.geometry
    kept = ~_beyond(model, data.wavelength_nm, geometry) if theta_max_deg is None else _within(geometry, theta_max_deg)
    _require_some(kept, theta_max_deg)
    left_out = len(kept) - int(kept.sum())
    if left_out > 0 and theta_max_deg is None:
        warn(
            f"{left_out} of {len(kept)} samples beyond the fitted range are left out: theta_max_deg=90 takes all",
            "ExtrapolationWarning",
        )
    data = data if left_out == 0 else data[np.flatnonzero(kept)]
    _warn_of_extrapolation(model, data.wavelength_nm, data.geometry)
    return data


def _common_wavelengths(models: tuple[Any, Any]) -> list[float]:
    """To which both were fitted, as far as they say."""
    elsewhere = int(Outside.WAVELENGTH | Outside.INTERPOLATED)
    known = models[0].wavelengths_nm or models[1].wavelengths_nm
    return [nm for nm in known if not any(one.outside(nm, 0, 0, 0, 0) & elsewhere for one in models)]


def _whole(parts: list[Any]) -> Any:
    """One Significance of those at each wavelength."""
    samples = sum(one.samples for one in parts)
    return max(parts, key=lambda one: one.largest)._replace(
        samples=samples,
        mean=sum(one.samples * one.mean for one in parts) / samples,
        within=sum(one.samples * one.within for one in parts) / samples,
    )


class _Directions(NamedTuple):
    """Where two models are compared."""

    wavelength_nm: np.ndarray
    geometry: Any
    kept: np.ndarray
    """Of each wavelength and direction."""
    by_default: bool
    """They are those of the compiled part, which looks at polar angles, and has them in radians."""

    def at(self, which: np.ndarray) -> Any:
        return type(self.geometry)(*(one[which] for one in self.geometry))


def _of_models(compiled: Any, models: tuple[Any, Any], nm: Any, geometry: Any, theta_max_deg: Any) -> _Directions:
    grid = compiled.germer2017_grid()
    whole = type(grid)(*map(np.ravel, np.broadcast_arrays(*(grid if geometry is None else geometry))))
    wavelengths = np.atleast_1d(nm).reshape(-1, 1)
    kept = np.ones((len(wavelengths), len(whole.theta_i_deg)), bool)
    by_default = geometry is None and theta_max_deg is None
    if theta_max_deg is not None:
        kept &= _within(whole, theta_max_deg)
    elif geometry is None:
        for one in models:
            kept &= ~_beyond(one, wavelengths, whole)
            by_default &= not _beyond(one, wavelengths, whole, Outside.DIRECTIONS).any()
    _require_some(kept, theta_max_deg)
    result = _Directions(wavelengths.ravel(), whole, kept, by_default)
    at_wavelength, direction = np.nonzero(kept)
    for one in models:
        _warn_of_extrapolation(one, result.wavelength_nm[at_wavelength], result.at(direction))
    return result


def _compared(
    compiled: Any, plain: Callable[..., Any], models: tuple[Any, Any], there: _Directions, printed: bool
) -> Any:
    """Of two models; the directions may be others at each wavelength."""
    if (there.kept == there.kept[0]).all():
        geometry = None if there.by_default else there.at(there.kept[0])
        return plain(*models, there.wavelength_nm, geometry, as_printed=printed)
    data = compiled.simulate(models[1], there.wavelength_nm, there.geometry)
    found = plain(models[0], data[np.flatnonzero(there.kept)], as_printed=printed)
    parts = [
        plain(*models, nm, there.at(kept), as_printed=printed).significance
        for nm, kept in zip(there.wavelength_nm, there.kept)
        if kept.any()
    ]
    if parts[0] is None:
        return found
    return found._replace(
        significance={
            name: _whole([one[name] for one in parts if name in one]) for name in dict.fromkeys(itertools.chain(*parts))
        }
    )


def install(compiled: Any) -> None:
    """Puts it around what the compiled part compares."""
    plain: Callable[..., Any] = compiled.compare

    def compare(
        model: Any,
        other: Any,
        wavelength_nm: Any = None,
        geometry: Any = None,
        *,
        as_printed: bool = False,
        theta_max_deg: Any = None,
    ) -> Any:
        if theta_max_deg is not None and not 0 < number("theta_max_deg", theta_max_deg) <= 90:
            raise ValueError(f"theta_max_deg = {theta_max_deg:g}: must be in (0, 90] degrees")
        samples = [isinstance(one, compiled.Dataset) for one in (model, other)]
        if samples == [True, True]:
            if wavelength_nm is not None:
                model, other = (one.at_wavelengths(wavelength_nm) for one in (model, other))
            _require_common(model, other)
            model, other = (compiled.fit(one).model for one in (model, other))
        elif samples == [False, True] and geometry is None:
            other = other if wavelength_nm is None else other.at_wavelengths(wavelength_nm)
            other = _of_samples(model, other, theta_max_deg)
        if not isinstance(other, compiled.Dataset) and not isinstance(model, compiled.Dataset):
            models = (model, other)
            nm = _common_wavelengths(models) if wavelength_nm is None else wavelength_nm
            if np.size(nm) > 0:  # else the compiled part says that it needs one
                there = _of_models(compiled, models, nm, geometry, theta_max_deg)
                return _compared(compiled, plain, models, there, as_printed)
        return plain(model, other, wavelength_nm, geometry, as_printed=as_printed)

    head, _, rest = plain.__doc__.partition("\n")
    inner, _, result = head.rpartition(") -> ")
    documentation = f"{inner}, theta_max_deg: Optional[float] = None) -> {result}\n{rest.rstrip()}{_MORE}"
    compiled.compare = _calls.wrapped(compare, "compare", documentation)
