# SPDX-License-Identifier: BSD-3-Clause
"""compare() of what `mmbrdf compare` compares: within the fitted ranges, unless it is said how far."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from . import _calls
from ._arguments import number
from ._results import Outside
from ._warnings import warn

_BEYOND = Outside.THETA_I | Outside.THETA_R | Outside.DIRECTIONS
_ROUNDING_DEG = 1e-7  # files give degrees

_MORE = """
theta_max_deg  only where both polar angles are at most this; None: without what lies beyond the fitted angles of a
               model, with an ExtrapolationWarning of samples that are left out. A geometry that is given is taken as
               it is"""


def _beyond(model: Any, geometry: Any, ranges: Outside = _BEYOND) -> np.ndarray:
    """Which directions are beyond the fitted angles, that hold at all wavelengths."""
    return (np.atleast_1d(model.outside(500.0, *geometry)) & int(ranges)) != 0


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
    kept = ~_beyond(model, geometry) if theta_max_deg is None else _within(geometry, theta_max_deg)
    _require_some(kept, theta_max_deg)
    left_out = len(kept) - int(kept.sum())
    if left_out > 0 and theta_max_deg is None:
        warn(
            f"{left_out} of {len(kept)} samples beyond the fitted range are left out: theta_max_deg=90 takes all",
            "ExtrapolationWarning",
        )
    return data if left_out == 0 else data[np.flatnonzero(kept)]


def _of_models(compiled: Any, models: tuple[Any, Any], geometry: Any, theta_max_deg: float | None) -> Any:
    """Where two models are compared. None: where the compiled part does, which looks at polar angles."""
    if theta_max_deg is None:
        grid = compiled.germer2017_grid()
        if geometry is not None or not any(_beyond(one, grid, Outside.DIRECTIONS).any() for one in models):
            return geometry
        geometry, kept = grid, ~(_beyond(models[0], grid) | _beyond(models[1], grid))
    else:
        grid = compiled.germer2017_grid() if geometry is None else geometry
        geometry = type(compiled.germer2017_grid())(*np.broadcast_arrays(*grid))
        kept = _within(geometry, theta_max_deg)
    _require_some(kept, theta_max_deg)
    return type(geometry)(*(one[kept] for one in geometry))


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
            geometry = _of_models(compiled, (model, other), geometry, theta_max_deg)
        return plain(model, other, wavelength_nm, geometry, as_printed=as_printed)

    head, _, rest = plain.__doc__.partition("\n")
    inner, _, result = head.rpartition(") -> ")
    documentation = f"{inner}, theta_max_deg: Optional[float] = None) -> {result}\n{rest.rstrip()}{_MORE}"
    compiled.compare = _calls.wrapped(compare, "compare", documentation)
