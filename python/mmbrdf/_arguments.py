# SPDX-License-Identifier: BSD-3-Clause
"""Arguments of functions in Python are checked where they come in: TypeError for another kind of thing."""

from __future__ import annotations

import operator
from collections.abc import Iterable
from typing import Any

import numpy as np

from ._mmbrdf import Dataset, FitResult, Model


def require(name: str, value: Any, *kinds: type) -> None:
    """Raises TypeError unless the argument called ``name`` is one of these kinds of thing."""
    if not isinstance(value, kinds):
        expected = " or ".join(f"mmbrdf.{kind.__name__}" for kind in kinds)
        hint = ": its .model is one" if isinstance(value, FitResult) and Model in kinds else ""
        raise TypeError(f"{name}: expected {expected}, not {type(value).__name__}{hint}")


def joined_masks(value: Any) -> Any:
    """Of a list that holds masked arrays one such array: numpy's own functions forget those masks. Anything else as it is."""
    if not isinstance(value, list | tuple):
        return value
    parts = [joined_masks(one) if isinstance(one, list | tuple) else one for one in value]
    if not any(isinstance(one, np.ma.MaskedArray) for one in parts):
        return value
    try:
        return np.ma.stack([np.ma.asanyarray(one) for one in parts])
    except ValueError:
        return value  # of other lengths, which is refused


def unmasked(name: str, value: Any) -> Any:
    """The argument called ``name``. Raises ValueError where something of it is masked: it would count."""
    if np.ma.is_masked(joined_masks(value)):
        raise ValueError(f"{name}: a part of it is masked; leave it out")
    return value


def nan_where_masked(value: Any, dtype: Any) -> np.ndarray:
    """As an array, with nan for what is masked: of integers as one of this type."""
    value = joined_masks(value)
    if not np.ma.is_masked(value):
        return np.asarray(value)
    array = np.ma.asanyarray(value)
    return np.asarray(array.astype(array.dtype if array.dtype.kind in "fc" else dtype).filled(np.nan))


def number(name: str, value: Any) -> float:
    """The argument called ``name`` as a finite number. Raises TypeError for another thing, ValueError for nan and inf."""
    array = np.asarray(unmasked(name, value))
    if array.ndim > 0 or array.dtype.kind not in "iuf":
        raise TypeError(f"{name}: expected a number, not {value!r}"[:200])
    if not np.isfinite(array):
        raise ValueError(f"{name} = {float(array)}, must be finite")
    return float(array)


def two_orders(value: Any) -> tuple[int, int]:
    """The argument called orders. Raises ValueError for anything but two whole numbers."""
    try:
        f11, others = (operator.index(one) for one in value)
    except (TypeError, ValueError):
        raise ValueError(f"orders = {value!r}, expected two whole numbers: of f11, and of the others"[:200]) from None
    return f11, others


def own_wavelength(source: Model | Dataset, wavelength_nm: Any = None) -> float | None:
    """The wavelength in nm if it is given, else that of a source that has only one.

    None of a model that does not say its own: it needs none, or refuses to be evaluated, with the reason.
    """
    if wavelength_nm is not None:
        return number("wavelength_nm", wavelength_nm)
    own = source.wavelengths_nm
    if len(own) != 1 and isinstance(source, Dataset):
        raise ValueError(f"the samples are at {', '.join(f'{nm:g}' for nm in own) or 'no'} nm: give one wavelength")
    return own[0] if len(own) == 1 else None


def several_models(name: str, value: Any) -> list[Model]:
    """One model or a sequence of them as a list. Raises TypeError for other things."""
    models = list(value) if isinstance(value, Iterable) else [value]
    for model in models:
        require(name, model, Model)
    return models


def require_measured(source: object, elements: Iterable[str] | None = None) -> None:
    """Refuses a model that does not know these elements, or all: what is drawn needs them."""
    unknown = [e for e in getattr(source, "not_measured", []) if elements is None or e in elements]
    if unknown:
        raise ValueError(f"not measured, and needed here: {', '.join(unknown)}")
