# SPDX-License-Identifier: BSD-3-Clause
"""Stacks of frames, dark frames and masks: their shapes, and the names of their axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _chunks
from .._arguments import joined_masks, nan_where_masked, number
from .._mmbrdf import Polarimeter
from .instruments import PixelInstrument, _frames

if TYPE_CHECKING:
    import xarray


_ROWS_AT_ONCE = 1 << 15  # pixels: what is in between stays near the cache, whatever the size of the image


def _checked(stack: Any, instrument: Polarimeter | PixelInstrument) -> None:
    """Refuses a stack of no real numbers, and one that is not the instrument's, and says which axis it is."""
    if stack.dtype.kind not in "biuf":
        raise TypeError(f"stack: expected real numbers, not {stack.dtype}")
    shape = stack.shape
    if len(shape) < 1 or shape[-1] != _frames(instrument):
        raise ValueError(
            f"stack: shape {tuple(shape)}: the last axis has {shape[-1] if shape else 0} frames, the instrument "
            f"{_frames(instrument)}"
        )
    if isinstance(instrument, PixelInstrument) and tuple(shape[:-1]) != instrument.shape:
        raise ValueError(f"stack: axes y, x are {tuple(shape[:-1])}, those of the instrument {instrument.shape}")


def _saturation(value: Any) -> float | None:
    return None if value is None or (isinstance(value, float) and value == np.inf) else number("saturation", value)


def _dark_for(dark: Any, stack: Any) -> Any:
    """As it broadcasts against the stack: one number, a frame (y, x), (frame,) or all."""
    if dark is None:
        return None
    array = dark if _chunks.is_lazy(dark) and _chunks.is_lazy(stack) else nan_where_masked(dark, np.float32)
    if array.shape == tuple(stack.shape[:-1]):
        return array[..., None]
    if array.ndim == 0 or array.shape == tuple(stack.shape[-1:]) or array.shape == tuple(stack.shape):
        return array
    raise ValueError(
        f"dark: shape {tuple(array.shape)}, expected a number, (y, x) = {tuple(stack.shape[:-1])}, "
        f"(frame,) = {tuple(stack.shape[-1:])} or the stack's {tuple(stack.shape)}"
    )


def _mask_for(mask: Any, stack: Any) -> Any:
    if mask is None:
        return None
    array = mask if _chunks.is_lazy(mask) and _chunks.is_lazy(stack) else np.ma.filled(joined_masks(mask), False)
    if array.dtype.kind != "b" or tuple(array.shape) != tuple(stack.shape[:-1]):
        raise ValueError(
            f"mask: {array.dtype} of shape {tuple(array.shape)}, expected truth values (y, x) = {tuple(stack.shape[:-1])}"
        )
    return array


def _named_axes(stack: xarray.DataArray, own: Any) -> tuple[tuple[Any, ...], Any]:
    """The outer axes in the order of the instrument, and that of the frames."""
    dims = tuple(stack.dims)
    frame = "frame" if "frame" in dims else dims[-1] if dims else "frame"
    outer = tuple(name for name in dims if name != frame)
    if frame in ("y", "x") or frame not in dims:
        raise ValueError(f"stack: dimensions {dims}: none is called 'frame': rename it")
    if not isinstance(own, PixelInstrument):
        return outer, frame
    if set(outer) != {"y", "x"}:
        raise ValueError(
            f"stack: dimensions {dims}, expected 'y', 'x' and 'frame', as those of an instrument for each pixel: rename them"
        )
    return ("y", "x"), frame


def _plain(name: str, array: Any, dims: tuple[Any, ...], given: tuple[Any, ...]) -> Any:
    """Dark frames or a mask without names, in the order of the stack's dims: by their own, else as `given` outer ones."""
    if hasattr(array, "dims"):
        if set(array.dims) not in (set(dims), set(dims[:-1]), {dims[-1]}, set()):
            raise ValueError(f"{name}: dimensions {tuple(array.dims)}, those of the stack are {dims}")
        return array.transpose(*[one for one in dims if one in array.dims]).data
    if array is None or np.ndim(array) < 2 or given == dims[:-1]:
        return array
    own = [given.index(one) for one in dims[:-1]]
    more = list(range(len(own), np.ndim(array)))
    if len(more) > 1 or np.ndim(array) < len(own):
        return array  # whose shape is refused
    return (array if _chunks.is_lazy(array) else np.ma.asanyarray(array)).transpose([*own, *more])


def _by_name(name: str, stack: Any, dims: tuple[str, ...]) -> Any:
    if not hasattr(stack, "dims"):
        return stack
    if set(stack.dims) != set(dims):
        raise ValueError(f"{name}: dimensions {tuple(stack.dims)}, expected {', '.join(dims)}: rename them")
    return stack.transpose(*dims).values
