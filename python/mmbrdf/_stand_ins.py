# SPDX-License-Identifier: BSD-3-Clause
"""What can be checked of a lazy call is checked at once: the eager function is called with a few numbers in the place of each lazy array, and
so refuses what it refuses, in its words."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from . import _mmbrdf
from ._signatures import DIRECTIONS, MATRIX

_MOST = 1000  # numbers of an array that is not lazy, for it is given to every chunk anyway

_NUMBERS = dict(zip(DIRECTIONS, (20.0, 10.0, 30.0, 100.0)))
_NUMBERS |= {"azimuth_deg": 10.0, "angle_deg": 10.0, "retardance_deg": 40.0, "extinction": 0.1, "f11": 0.3}
_NUMBERS |= {"u1": 0.3, "u2": 0.6, "pdf": 1.0}


@functools.cache
def _matrix() -> np.ndarray:
    """One of which every quantity has a value and slopes."""
    depolarizing = np.diag([1.0, 0.6, 0.5, 0.4])
    return np.asarray(0.5 * depolarizing + 0.5 * _mmbrdf.retarder(70.0, 25.0) @ _mmbrdf.polarizer(10.0, 0.3))


def _wavelength(given: Mapping[str, Any]) -> float:
    model = given.get("self", given.get("model"))
    return next(iter(getattr(model, "wavelengths_nm", None) or []), 532.0)


def _in_the_place_of(name: str, core: Sequence[str], sizes: Mapping[str, int], given: Mapping[str, Any]) -> Any:
    if name in _NUMBERS:
        return _NUMBERS[name]
    if name == "wavelength_nm":
        return _wavelength(given)
    if core == MATRIX:
        return _matrix()
    if name in ("stokes", "analyzer"):
        return np.array([1.0, 0.3, 0.2, 0.1])
    return np.eye(16) if name == "covariance" else np.ones([sizes[axis] for axis in core])


def stand_in(name: str, value: Any, core: Sequence[str], sizes: Mapping[str, int], given: Mapping[str, Any]) -> Any:
    """For a lazy array whose last axes are these: numbers, or others of its kind if it has no numbers."""
    dtype = getattr(value, "dtype", np.dtype(float))
    like = np.asarray(_in_the_place_of(name, core, sizes, given))
    return like if dtype.kind in "biuf" else np.zeros(like.shape, dtype)


def _shape(value: Any) -> tuple[int, ...] | None:
    """None of rows of other lengths, which are refused as such."""
    try:
        return np.shape(value)
    except ValueError:
        return None


def shapes_fit(arrays: Mapping[str, Any], cores: Mapping[str, Sequence[str]], sizes: Mapping[str, int]) -> bool:
    """Whether the last axes are as long as they must be, and the others broadcast. True of DataArrays, of whose names and sizes
    xarray says that, and of chunks of unknown sizes."""
    if any(hasattr(value, "dims") for value in arrays.values()):
        return True
    outer = []
    for name, value in arrays.items():
        shape = _shape(value)
        if shape is None or np.isnan(shape).any():
            return True
        place = max(len(shape) - len(cores[name]), 0)
        if value is not None and shape[place:] != tuple(sizes[axis] for axis in cores[name]):
            return False
        outer.append(shape[:place])
    try:
        np.broadcast_shapes(*outer)
    except ValueError:
        return False
    return True


def shape_alone(value: Any) -> np.ndarray:
    """For a lazy array whose shape is refused: as large, of one number in memory."""
    return np.broadcast_to(0.0, value.shape)


def fewest_draws(count: Any) -> Any:
    """In the place of many that there may be."""
    return 2 if isinstance(count, int | np.integer) and 2 < count <= 1_000_000 else count


def shortened(value: Any, core: Sequence[str]) -> Any:
    """An array that is not lazy: the first part of a large one."""
    if _shape(value) is None:
        return value
    while np.size(value) > _MOST and np.ndim(value) > len(core):
        axis = int(np.argmax(np.shape(value)[: np.ndim(value) - len(core)]))
        if np.shape(value)[axis] == 1:
            break
        value = np.asanyarray(value)[(slice(None),) * axis + (slice(1),)]
    return value


def tried(function: Callable[..., Any], arguments: Mapping[str, Any]) -> Any:
    """What it gives of stand-ins: raises what the eager call raises. Of extrapolation is warned when it is computed."""
    asked = {name: value for name, value in arguments.items() if name not in ("out", "as_xarray", "by_term")}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return function(**asked)
