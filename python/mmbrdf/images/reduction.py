# SPDX-License-Identifier: BSD-3-Clause
"""Stacks of frames to matrices: of numpy arrays at once, of Dask arrays and DataArrays in chunks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .. import _chunks, _mmbrdf
from .._arguments import nan_where_masked
from .._mmbrdf import Polarimeter
from .._signatures import MATRIX
from .instruments import PixelInstrument, _core_shape, _Instrument, _polarimeter
from .stacks import _ROWS_AT_ONCE, _checked, _dark_for, _mask_for, _named_axes, _plain, _saturation

if TYPE_CHECKING:
    import xarray


def _corrected(some: NDArray[Any], dark: NDArray[Any] | None, saturation: float | None, mask: Any) -> NDArray[Any]:
    """Readings of a block of pixels; NaN in one of them where it counts for nothing."""
    dtype = np.float64 if some.dtype == np.float64 else np.float32
    if dark is None and saturation is None and mask is None:
        return np.ascontiguousarray(some, dtype)
    bad = None if saturation is None else (some >= saturation).any(axis=-1)
    if mask is not None:
        bad = np.logical_not(mask) if bad is None else bad | np.logical_not(mask)
    result = np.array(some, dtype) if dark is None else np.subtract(some, dark, dtype=dtype)
    if bad is not None:
        result[..., 0][bad] = np.nan
    return result


def _reduced(
    stack: NDArray[Any],
    instrument: Polarimeter | PixelInstrument,
    dark: NDArray[Any] | None,
    saturation: float | None,
    mask: NDArray[Any] | None,
    progress: Callable[[Any], Any] | None,
) -> NDArray[Any]:
    frames, outer = stack.shape[-1], stack.shape[:-1]
    dtype = np.float64 if stack.dtype == np.float64 and isinstance(instrument, Polarimeter) else np.float32
    result = np.empty((*outer, 4, 4), dtype)
    rows = max(1, _ROWS_AT_ONCE // max(1, outer[-1] if outer else 1))
    starts: Iterable[int] = range(0, outer[0], rows) if len(outer) > 1 else range(1)
    if progress is not None:
        starts = progress(starts)
    if (
        dark is None
        and saturation is None
        and mask is None
        and isinstance(instrument, Polarimeter)
        and progress is None
    ):
        given = stack if stack.dtype in (np.float32, np.float64) else stack.astype(np.float32)
        return np.asarray(instrument.reduce(given.reshape(*outer, *_core_shape(instrument)), invalid="nan"))
    for first in starts:
        here = slice(first, first + rows) if len(outer) > 1 else ...
        cut = lambda a: None if a is None else (a[here] if np.ndim(a) >= len(outer) else a)  # noqa: E731
        some = _corrected(stack[here], cut(dark), saturation, cut(mask))
        if isinstance(instrument, Polarimeter):
            result[here] = instrument.reduce(some.reshape(*some.shape[:-1], *_core_shape(instrument)), invalid="nan")
        else:
            limit = _mmbrdf._limit_threads(0)
            _mmbrdf._limit_threads(limit)
            pixel = first * outer[-1] if len(outer) > 1 else 0
            matrices = instrument._prepared().reduce(some.reshape(-1, frames), pixel, limit)
            result[here] = matrices.reshape(*some.shape[:-1], 4, 4)
    return result


def reduce(
    stack: Any,
    instrument: _Instrument,
    *,
    dark: Any = None,
    saturation: float | None = None,
    mask: Any = None,
    progress: Callable[[Any], Any] | None = None,
) -> Any:
    """Mueller matrices (y, x, 4, 4) of a stack of frames (y, x, frame), by least squares.

    instrument  Polarimeter or Calibration: the same for all pixels; PixelInstrument: one for each
    dark        is subtracted: a number, or an array (y, x), (frame,) or (y, x, frame)
    saturation  a pixel with a frame at or above it is NaN
    mask        truth values (y, x): False is not reduced, and NaN
    progress    of a numpy array: such as tqdm.tqdm, which is given what is gone through. Dask has its own

    Result: float32, or float64 of a stack of float64 by one instrument. A pixel with a reading that is not finite or is
    masked, or without calibration, is NaN. A DataArray gives one with its coordinates, in its order of axes, a Dask array one that is
    lazy. Names count and not the order: dark and mask may have names, too, and without them have the order of the stack;
    with an instrument for each pixel the axes must be called y and x, and frames "frame" or come last.
    Raises ValueError, naming axis and sizes, for another number of frames or pixels than the instrument has, and for
    chunks that cut the frames.
    """
    own = _polarimeter(instrument)
    saturation = _saturation(saturation)
    if hasattr(stack, "dims"):
        return _reduced_named(stack, own, dark, saturation, mask)
    image = ("y", "x", "frame")
    dark, mask = _plain("dark", dark, image, image[:-1]), _plain("mask", mask, image, image[:-1])
    if _chunks.is_lazy(stack):
        return _reduced_lazily(stack, own, dark, saturation, mask)
    array = nan_where_masked(stack, np.float32)
    _checked(array, own)
    return _reduced(array, own, _dark_for(dark, array), saturation, _mask_for(mask, array), progress)


def _reduced_lazily(stack: Any, own: Polarimeter | PixelInstrument, dark: Any, saturation: Any, mask: Any) -> Any:
    import dask.array

    _checked(stack, own)
    _chunks.require_whole("stack", stack, ("frame",))
    given = [dask.array.asarray(stack)]
    cores: list[tuple[str, ...]] = [("frame",)]
    dark, mask = _dark_for(dark, stack), _mask_for(mask, stack)
    names = []
    for name, array in (("dark", dark), ("mask", mask)):
        if array is None:
            continue
        if name == "dark" and not _chunks.is_lazy(array) and (array.ndim == 0 or array.shape == stack.shape[-1:]):
            continue
        whole = dask.array.asarray(array)
        if name == "dark":
            whole = dask.array.broadcast_to(whole, stack.shape)
        given.append(whole.rechunk(stack.chunks[: whole.ndim]))
        cores.append(("frame",) if name == "dark" else ())
        names.append(name)
    fixed = dark if "dark" not in names else None
    work = _Block(own if isinstance(own, Polarimeter) else None, fixed, saturation, names)
    if isinstance(own, PixelInstrument):  # its states go with the chunks
        for states in (own.generator, own.analyzer):
            given.append(dask.array.from_array(states, chunks=(*stack.chunks[:-1], -1, -1)))
        cores += [("generator", "four"), ("analyzer", "four")]
        work.pairs = own.pairs
    single = stack.dtype != np.float64 or isinstance(own, PixelInstrument)
    return _chunks.by_chunk(work, given, cores, MATRIX, _chunks.SIZES, np.float32 if single else np.float64)


class _Block:
    """The reduction of a chunk: it can be sent."""

    function = "reduce"  # as Dask shows it

    def __init__(self, own: Polarimeter | None, dark: Any, saturation: Any, names: Sequence[str]):
        self.own, self.dark, self.saturation, self.names = own, dark, saturation, list(names)
        self.pairs: NDArray[Any] | None = None

    def __call__(self, stack: NDArray[Any], *more: NDArray[Any]) -> NDArray[Any]:
        stack = nan_where_masked(stack, np.float32)
        given = {
            name: nan_where_masked(one, np.float32) if name == "dark" else np.ma.filled(one, False)
            for name, one in zip(self.names, more)
        }
        own: Polarimeter | PixelInstrument
        before = _mmbrdf._limit_threads(1)
        try:
            if self.own is None:
                generator, analyzer = more[len(self.names) :]
                own = PixelInstrument(generator, analyzer, pairs=self.pairs)
                if not np.isfinite(generator).all(axis=(2, 3)).any():
                    return np.full((*stack.shape[:-1], 4, 4), np.nan, np.float32)
            else:
                own = self.own
            return _reduced(stack, own, given.get("dark", self.dark), self.saturation, given.get("mask"), None)
        finally:
            _mmbrdf._limit_threads(before)


def _reduced_named(stack: xarray.DataArray, own: Any, dark: Any, saturation: Any, mask: Any) -> xarray.DataArray:
    import xarray

    outer, frame = _named_axes(stack, own)
    _chunks.require_whole("stack", stack, (str(frame),))
    ordered = stack.transpose(*outer, frame)
    given = tuple(name for name in stack.dims if name != frame)
    plain = [_plain(name, array, (*outer, frame), given) for name, array in (("dark", dark), ("mask", mask))]
    values = reduce(ordered.data, own, dark=plain[0], saturation=saturation, mask=plain[1])
    kept = {name: c for name, c in ordered.coords.items() if frame not in c.dims}
    labels = {"row": np.arange(1, 5), "column": np.arange(1, 5)}
    attributes = {**stack.attrs, "long_name": "Mueller matrix", "frame": "scattering_plane"}
    attributes.pop("units", None)
    result = xarray.DataArray(values, {**kept, **labels}, [*outer, "row", "column"], "mueller", attributes)
    return result.transpose(*given, "row", "column")
