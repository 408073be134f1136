# SPDX-License-Identifier: BSD-3-Clause
"""Imaging polarimeters: stacks of frames to Mueller matrices, and an instrument in each pixel.

    instrument = mmbrdf.images.calibrate(references, stacks)             # one for each pixel, from (reference, y, x, frame)
    matrices = mmbrdf.images.reduce(stack, instrument, dark=dark, saturation=4000)    # (y, x, 4, 4), NaN where unknown
    mmbrdf.depolarization(matrices, invalid="nan")                       # and all else that takes matrices
    models = mmbrdf.images.PixelFit(532, geometry).fit(values)           # a BRDF in each pixel

A stack has the axes (y, x, frame): frames are those of the instrument, in the order of its readings, all generator states
of the first analyzer state first. numpy arrays are worked on at once, on all cores; Dask arrays and xarray.DataArrays, whose
frames may be called "frame", lazily, a chunk on one thread, with the same bits. float32 stays float32; integers, as cameras
have them, become float32.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _lazy, _mmbrdf
from ._arguments import number
from ._mmbrdf import Calibration, Polarimeter
from ._pixel_fits import PixelFit, PixelModels, load_models

if TYPE_CHECKING:
    import xarray

__all__ = [
    "FAILURES",
    "PixelFit",
    "PixelInstrument",
    "PixelModels",
    "Reference",
    "calibrate",
    "join",
    "load_models",
    "quantities",
    "readings",
    "reduce",
    "simulate",
    "uncertainty",
]

FAILURES = ("", "not finite", "no convergence", "misfit", "dependent states", "masked")
"""What the numbers of PixelInstrument.failure mean: 0 is a calibrated pixel."""

_ROWS_AT_ONCE = 1 << 15  # pixels: what is in between stays near the cache, whatever the size of the image


class Reference(NamedTuple):
    """What was before the camera: the lines of a file of references, without readings."""

    kind: str
    """"empty", "polarizer", "wafer" or "retarder"."""
    angle_deg: float = 0.0
    """Dial of the polarizer, angle of incidence on the wafer, azimuth of the retarder's fast axis."""
    s_exceeds_p: int = 0
    """Wafer: 1 if |rs| > |rp|, -1 if not."""
    delta_sign: int = 0
    """Sign of the wafer's or retarder's delta; 0 of a retarder: below 180 degrees."""


class PixelInstrument:
    """An instrument for each pixel of an image: what calibrate() gives, and reduce() takes. It can be pickled."""

    def __init__(
        self,
        generator: ArrayLike,
        analyzer: ArrayLike,
        *,
        pairs: ArrayLike | None = None,
        values: Mapping[str, NDArray[Any]] | None = None,
        start: Calibration | None = None,
    ):
        """generator (y, x, states, 4), analyzer (y, x, states, 4), pairs as of a Polarimeter.

        Raises ValueError for shapes that do not fit each other.
        """
        self.generator = np.asarray(generator, float)
        self.analyzer = np.asarray(analyzer, float)
        for name, array in (("generator", self.generator), ("analyzer", self.analyzer)):
            if array.ndim != 4 or array.shape[-1] != 4:
                raise ValueError(f"{name}: shape {array.shape}, expected (y, x, states, 4)")
        if self.generator.shape[:2] != self.analyzer.shape[:2]:
            raise ValueError(
                f"generator: {self.generator.shape[:2]} pixels, analyzer: {self.analyzer.shape[:2]}: axes y and x differ"
            )
        self.pairs = None if pairs is None else np.asarray(pairs, np.int64)
        values = values or {}
        self.misfit = values.get("misfit")
        """(y, x): chi squared per degree of freedom."""
        self.failure = values.get("failure", np.zeros(self.shape, np.uint8))
        """(y, x): 0, or why a pixel has no calibration: a place in FAILURES."""
        self.u_generator = values.get("u_generator")
        """(y, x, states, 4): standard uncertainties of the states, of a calibration of a grid of states."""
        self.u_analyzer = values.get("u_analyzer")
        self.retarders = values.get("retarders")
        """(y, x, 10): the numbers of two turning retarders, as Calibration.retarders names them, angles in degrees."""
        self.u_retarders = values.get("u_retarders")
        self.start = start
        """The instrument that the median of the image gave, from which all pixels started."""
        self._inverses: _mmbrdf._PixelInverses | None = None

    @property
    def shape(self) -> tuple[int, int]:
        """(y, x)"""
        return self.generator.shape[0], self.generator.shape[1]

    @property
    def polarimeter(self) -> Polarimeter:
        """Of the first pixel that is calibrated."""
        good = np.argwhere(np.isfinite(self.generator).all(axis=(2, 3)) & np.isfinite(self.analyzer).all(axis=(2, 3)))
        if len(good) == 0:
            raise ValueError("no pixel is calibrated")
        return self.at(*map(int, good[0]))

    @property
    def frames(self) -> int:
        """Readings of a pixel."""
        return self.generator.shape[2] * self.analyzer.shape[2] if self.pairs is None else len(self.pairs)

    def at(self, y: int, x: int) -> Polarimeter:
        """The instrument of one pixel. Raises ValueError for one that is not calibrated."""
        if not (np.isfinite(self.generator[y, x]).all() and np.isfinite(self.analyzer[y, x]).all()):
            raise ValueError(f"pixel ({y}, {x}) is not calibrated: {FAILURES[int(self.failure[y, x])] or 'not finite'}")
        return Polarimeter(self.generator[y, x], self.analyzer[y, x], self.pairs)

    def __getitem__(self, where: tuple[slice, slice]) -> PixelInstrument:
        """Some rows and columns of pixels."""
        names = ("misfit", "failure", "u_generator", "u_analyzer", "retarders", "u_retarders")
        values = {name: getattr(self, name)[where] for name in names if getattr(self, name) is not None}
        return PixelInstrument(
            self.generator[where], self.analyzer[where], pairs=self.pairs, values=values, start=self.start
        )

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_inverses": None}

    def __repr__(self) -> str:
        bad = int(np.count_nonzero(self.failure))
        return f"<mmbrdf.images.PixelInstrument: {self.shape[0]} x {self.shape[1]} pixels, {bad} without calibration>"

    def _prepared(self) -> _mmbrdf._PixelInverses:
        if self._inverses is None:
            self._inverses = _mmbrdf._PixelInverses(self.generator, self.analyzer, self.polarimeter)
        return self._inverses


def _kind_of(one: PixelInstrument) -> str:
    states = f"{one.generator.shape[2]} and {one.analyzer.shape[2]} states"
    retarders = ", with retarders" if one.retarders is not None else ""
    return f"{one.shape[1]} columns of {one.frames} frames of {states}{retarders}"


def join(instruments: Sequence[PixelInstrument]) -> PixelInstrument:
    """Instruments of rows of an image, one below the other, as one. Raises ValueError for others than of the same columns and kind."""
    if not instruments:
        raise ValueError("instruments: none")
    first = instruments[0]
    names = ("misfit", "failure", "u_generator", "u_analyzer", "retarders", "u_retarders")
    for k, one in enumerate(instruments):
        if (
            one.shape[1] != first.shape[1]
            or one.frames != first.frames
            or one.generator.shape[2] != first.generator.shape[2]
            or one.analyzer.shape[2] != first.analyzer.shape[2]
            or (one.retarders is None) != (first.retarders is None)
        ):
            raise ValueError(f"instruments: number {k} has {_kind_of(one)}, the first {_kind_of(first)}")
        if (one.pairs is None) != (first.pairs is None) or not np.array_equal(one.pairs, first.pairs):
            raise ValueError(f"instruments: number {k} has other pairs of states than the first")
    values = {
        name: np.concatenate([getattr(one, name) for one in instruments])
        for name in names
        if all(getattr(one, name) is not None for one in instruments)
    }
    return PixelInstrument(
        np.concatenate([one.generator for one in instruments]),
        np.concatenate([one.analyzer for one in instruments]),
        pairs=first.pairs,
        values=values,
        start=first.start,
    )


_Instrument = Polarimeter | Calibration | PixelInstrument


def _polarimeter(instrument: _Instrument) -> Polarimeter | PixelInstrument:
    if isinstance(instrument, Calibration):
        return instrument.polarimeter
    if isinstance(instrument, Polarimeter | PixelInstrument):
        return instrument
    raise TypeError(
        f"instrument: expected a Polarimeter, a Calibration or a PixelInstrument, not {type(instrument).__name__}"
    )


def _frames(instrument: Polarimeter | PixelInstrument) -> int:
    if isinstance(instrument, PixelInstrument):
        return instrument.frames
    pairs = instrument.pairs
    return len(instrument.generator) * len(instrument.analyzer) if pairs is None else len(pairs)


def _core_shape(instrument: Polarimeter) -> tuple[int, ...]:
    pairs = instrument.pairs
    return (len(instrument.analyzer), len(instrument.generator)) if pairs is None else (len(pairs),)


def _checked(stack: Any, instrument: Polarimeter | PixelInstrument) -> None:
    """Refuses a stack that is not the instrument's, and says which axis it is."""
    shape = stack.shape
    if len(shape) < 1 or shape[-1] != _frames(instrument):
        raise ValueError(
            f"stack: shape {tuple(shape)}: the last axis has {shape[-1] if shape else 0} frames, the instrument "
            f"{_frames(instrument)}"
        )
    if isinstance(instrument, PixelInstrument) and tuple(shape[:-1]) != instrument.shape:
        raise ValueError(f"stack: axes y, x are {tuple(shape[:-1])}, those of the instrument {instrument.shape}")


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


def _saturation(value: Any) -> float | None:
    return None if value is None or (isinstance(value, float) and value == np.inf) else number("saturation", value)


def _dark_for(dark: Any, stack: Any) -> Any:
    """As it broadcasts against the stack: one number, a frame (y, x), (frame,) or all."""
    if dark is None:
        return None
    array = dark if _lazy._is_lazy(dark) and _lazy._is_lazy(stack) else np.asarray(dark)
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
    array = mask if _lazy._is_lazy(mask) and _lazy._is_lazy(stack) else np.asarray(mask)
    if array.dtype.kind != "b" or tuple(array.shape) != tuple(stack.shape[:-1]):
        raise ValueError(
            f"mask: {array.dtype} of shape {tuple(array.shape)}, expected truth values (y, x) = {tuple(stack.shape[:-1])}"
        )
    return array


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

    Result: float32, or float64 of a stack of float64 by one instrument. A pixel with a reading that is not finite, or
    without calibration, is NaN. A DataArray gives one with its coordinates, in its order of axes, a Dask array one that is
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
    if _lazy._is_lazy(stack):
        return _reduced_lazily(stack, own, dark, saturation, mask)
    array = np.asarray(stack)
    if array.dtype.kind not in "biuf":
        raise TypeError(f"stack: expected real numbers, not {array.dtype}")
    _checked(array, own)
    return _reduced(array, own, _dark_for(dark, array), saturation, _mask_for(mask, array), progress)


def _reduced_lazily(stack: Any, own: Polarimeter | PixelInstrument, dark: Any, saturation: Any, mask: Any) -> Any:
    import dask.array

    _checked(stack, own)
    _lazy.require_whole("stack", stack, ("frame",))
    given = [dask.array.asarray(stack)]
    signature = ["(frame)"]
    dark, mask = _dark_for(dark, stack), _mask_for(mask, stack)
    names = []
    for name, array in (("dark", dark), ("mask", mask)):
        if array is None:
            continue
        if array.ndim == 0 or array.shape == stack.shape[-1:]:
            continue
        whole = dask.array.asarray(array)
        if name == "dark":
            whole = dask.array.broadcast_to(whole, stack.shape)
        given.append(whole.rechunk(stack.chunks[: whole.ndim]))
        signature.append("(frame)" if name == "dark" else "()")
        names.append(name)
    fixed = dark if "dark" not in names else None
    work = _Block(own if isinstance(own, Polarimeter) else None, fixed, saturation, names)
    if isinstance(own, PixelInstrument):  # its states go with the chunks
        for states in (own.generator, own.analyzer):
            given.append(dask.array.from_array(states, chunks=(*stack.chunks[:-1], -1, -1)))
        signature += ["(generator,four)", "(analyzer,four)"]
        work.pairs = own.pairs
    single = stack.dtype != np.float64 or isinstance(own, PixelInstrument)
    return dask.array.apply_gufunc(
        work,
        f"{','.join(signature)}->(row,column)",
        *given,
        output_dtypes=np.float32 if single else np.float64,
        output_sizes={"row": 4, "column": 4},
    )


class _Block:
    """The reduction of a chunk: it can be sent."""

    def __init__(self, own: Polarimeter | None, dark: Any, saturation: Any, names: Sequence[str]):
        self.own, self.dark, self.saturation, self.names = own, dark, saturation, list(names)
        self.pairs: NDArray[Any] | None = None

    def __call__(self, stack: NDArray[Any], *more: NDArray[Any]) -> NDArray[Any]:
        given = dict(zip(self.names, more))
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
    return (array if _lazy._is_lazy(array) else np.asarray(array)).transpose([*own, *more])


def _reduced_named(stack: xarray.DataArray, own: Any, dark: Any, saturation: Any, mask: Any) -> xarray.DataArray:
    import xarray

    outer, frame = _named_axes(stack, own)
    _lazy.require_whole("stack", stack, (str(frame),))
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


def readings(mueller: ArrayLike, instrument: _Instrument) -> NDArray[np.float64]:
    """The stack (y, x, frame) that matrices (y, x, 4, 4) give, without noise."""
    own = _polarimeter(instrument)
    if isinstance(own, PixelInstrument):
        mueller = _by_name("mueller", mueller, ("y", "x", "row", "column"))
    m = np.asarray(mueller, float)
    if isinstance(own, Polarimeter):
        return np.asarray(own.readings(m)).reshape(*m.shape[:-2], -1)
    if m.shape != (*own.shape, 4, 4):
        raise ValueError(f"mueller: shape {m.shape}, expected {(*own.shape, 4, 4)}")
    if own.pairs is None:
        grid = np.einsum("yxqi,yxij,yxpj->yxqp", own.analyzer, m, own.generator, optimize=True)
        return grid.reshape(*own.shape, -1)
    w, a = own.generator[:, :, own.pairs[:, 0]], own.analyzer[:, :, own.pairs[:, 1]]
    return np.einsum("yxfi,yxij,yxfj->yxf", a, m, w, optimize=True)


def _variance(noise: Mapping[str, float], stack: NDArray[Any]) -> NDArray[Any]:
    unknown = set(noise) - {"dark", "shot", "relative"}
    if unknown:
        raise ValueError(f"noise: {sorted(unknown)[0]}: expected dark, shot or relative")
    for name, one in noise.items():
        if number(f"noise: {name}", one) < 0:
            raise ValueError(f"noise: {name} = {one}, must be 0 or more")
    value = np.abs(stack.astype(float))
    return noise.get("dark", 0.0) ** 2 + noise.get("shot", 0.0) * value + (noise.get("relative", 0.0) * value) ** 2


def uncertainty(
    stack: Any,
    instrument: _Instrument,
    noise: Mapping[str, float],
    *,
    quantity: str | None = None,
) -> Any:
    """Standard uncertainties from independent noise of the frames: of the matrices (y, x, 4, 4), or of a quantity (y, x).

    stack     (y, x, frame), dark-subtracted: numpy, Dask or DataArray, whose names count as in reduce(). With a
              PixelInstrument not Dask, nor a lazy DataArray: go through rows of the image
    noise     {"dark": d, "shot": s, "relative": r}: variance d^2 + s |B| + (r B)^2 of a reading B, in its units
    quantity  any of mmbrdf.quantities() that takes no light, of the matrices as they are reduced

    float32 as what reduce() gives; NaN where that is, and where a quantity has no slope. The instrument's own uncertainty
    is not among it: it is the same error in neighbouring pixels.
    """
    own = _polarimeter(instrument)
    names = {q.name: q.unit for q in _mmbrdf.quantities() if not q.takes_light}
    units = names.get(quantity or "", "").replace("sr^-1", "")  # what is as the readings has those of their calibration
    if quantity is not None and quantity not in names:
        raise ValueError(f"quantity {quantity!r}: expected one of {', '.join(sorted(names))}")
    work = _Noise(own, dict(noise), quantity)
    _variance(noise, np.zeros(1))
    if hasattr(stack, "dims"):
        outer, frame = _named_axes(stack, own)
        ordered = stack.transpose(*outer, frame)
        values = uncertainty(ordered.data, own, noise, quantity=quantity)
        kept = {n: c for n, c in ordered.coords.items() if frame not in c.dims}
        core = [] if quantity else ["row", "column"]
        attributes = {**stack.attrs, "long_name": f"standard uncertainty of {quantity or 'mueller'}"}
        attributes.pop("units", None)  # those of readings
        if units:
            attributes["units"] = units
        result = type(stack)(values, kept, [*outer, *core], f"u of {quantity or 'mueller'}", attributes)
        return result.transpose(*[name for name in stack.dims if name != frame], *core)
    if not _lazy._is_lazy(stack):
        array = np.asarray(stack)
        _checked(array, own)
        return work(array)
    import dask.array

    _checked(stack, own)
    _lazy.require_whole("stack", stack, ("frame",))
    if isinstance(own, PixelInstrument):
        raise TypeError("stack: uncertainties of a PixelInstrument take numpy arrays: go through rows of the image")
    core = "" if quantity else "row,column"
    sizes = {} if quantity else {"row": 4, "column": 4}
    return dask.array.apply_gufunc(work, f"(frame)->({core})", stack, output_dtypes=np.float32, output_sizes=sizes)


class _Noise:
    def __init__(self, own: Polarimeter | PixelInstrument, noise: dict[str, float], quantity: str | None):
        self.own, self.noise, self.quantity = own, noise, quantity

    def __call__(self, stack: NDArray[Any]) -> NDArray[Any]:
        outer, frames = stack.shape[:-1], stack.shape[-1]
        result = np.empty(outer if self.quantity else (*outer, 4, 4), np.float32)
        flat, out = stack.reshape(-1, frames), result.reshape(-1) if self.quantity else result.reshape(-1, 16)
        shared = self._inverse(self.own) if isinstance(self.own, Polarimeter) else None
        for first in range(0, len(flat), _ROWS_AT_ONCE // 8):
            here = slice(first, first + _ROWS_AT_ONCE // 8)
            variance = _variance(self.noise, flat[here])
            inverse = shared if shared is not None else self._inverses(here)
            if self.quantity is None:
                out[here] = (
                    np.sqrt(np.einsum("pf,...fe->pe", variance, inverse**2))
                    if shared is not None
                    else np.sqrt(np.einsum("pf,pfe->pe", variance, inverse**2))
                )
                continue
            matrices = np.einsum("pf,fe->pe" if shared is not None else "pf,pfe->pe", flat[here].astype(float), inverse)
            slope = getattr(_mmbrdf, f"{self.quantity}_gradient")(matrices.reshape(-1, 4, 4), invalid="nan")
            of_frames = np.einsum("pe,fe->pf" if shared is not None else "pe,pfe->pf", slope.reshape(-1, 16), inverse)
            out[here] = np.sqrt(np.einsum("pf,pf->p", of_frames**2, variance))
        return result

    @staticmethod
    def _inverse(own: Polarimeter) -> NDArray[np.float64]:
        """(frame, 16): what each reading gives to the elements."""
        shape = _core_shape(own)
        frames = int(np.prod(shape))
        return np.asarray(own.reduce(np.eye(frames).reshape(frames, *shape))).reshape(frames, 16)

    def _inverses(self, here: slice) -> NDArray[np.float64]:
        """The same of each of some pixels."""
        own = self.own
        assert isinstance(own, PixelInstrument)
        w, a = (states.reshape(-1, *states.shape[2:])[here] for states in (own.generator, own.analyzer))
        pairs = own.pairs
        if pairs is None:
            pairs = np.array([(p, q) for q in range(a.shape[1]) for p in range(w.shape[1])])
        rows = np.einsum("pfi,pfj->pfij", a[:, pairs[:, 1]], w[:, pairs[:, 0]]).reshape(len(w), len(pairs), 16)
        good = np.isfinite(rows).all(axis=(1, 2))
        result = np.full((len(w), len(pairs), 16), np.nan)
        if good.any():
            result[good] = np.swapaxes(np.linalg.pinv(rows[good]), 1, 2)
        return result


def quantities(mueller: Any, names: Sequence[str]) -> Any:
    """Some of mmbrdf.quantities() of an image of matrices: {name: (y, x)}, NaN where one has none.

    Of a DataArray an xarray.Dataset. Raises ValueError for a name that there is not, and for one that takes light.
    """
    known = {q.name for q in _mmbrdf.quantities() if not q.takes_light}
    package = sys.modules[__package__ or "mmbrdf"]
    if isinstance(names, str):
        raise TypeError(f"names: expected a list of them, not {names!r}: give [{names!r}]")
    for name in names:
        if name not in known:
            raise ValueError(f"quantity {name!r}: expected one of {', '.join(sorted(known))}")
    result = {name: getattr(package, name)(mueller, invalid="nan") for name in names}
    if not hasattr(mueller, "dims"):
        return result
    import xarray

    return xarray.Dataset(result)


def _given_references(references: Sequence[Reference | tuple[Any, ...]]) -> list[Reference]:
    result = [Reference(*reference) for reference in references]
    if not result:
        raise ValueError("references: none")
    return result


def _stacks(stacks: Any) -> NDArray[np.float32]:
    """As (reference, y, x, frame), by names where there are some."""
    image = ("y", "x", "frame")
    if isinstance(stacks, list | tuple):
        return np.asarray([_by_name("stacks", one, image) for one in stacks], np.float32)
    return np.asarray(_by_name("stacks", stacks, ("reference", *image)), np.float32)


def _by_name(name: str, stack: Any, dims: tuple[str, ...]) -> Any:
    if not hasattr(stack, "dims"):
        return stack
    if set(stack.dims) != set(dims):
        raise ValueError(f"{name}: dimensions {tuple(stack.dims)}, expected {', '.join(dims)}: rename them")
    return stack.transpose(*dims).values


def calibrate(
    references: Sequence[Reference | tuple[Any, ...]],
    stacks: ArrayLike,
    *,
    wavelength_nm: float,
    generator_states: int = 4,
    analyzer_states: int = 4,
    dials_deg: ArrayLike | None = None,
    retardance_deg: float = 90.0,
    fit_extinction: bool = True,
    fit_diattenuation: bool = True,
    fit_drift: bool = True,
    fit_polarizer_phase: bool = False,
    polarizer_near_deg: float | None = None,
    dial_sense: int = 1,
    noise: Mapping[str, float] | None = None,
    saturation: float | None = None,
    mask: ArrayLike | None = None,
    start: Calibration | None = None,
    most_misfit: float = 100.0,
    threads: int = 0,
    progress: Callable[[Any], Any] | None = None,
) -> PixelInstrument:
    """An instrument for each pixel, from references before the camera: as mmbrdf.calibrate() of each, by maximum likelihood.

    references  Reference or its tuple, for each of the stacks; wafers with both signs, since no film is asked here
    stacks      (reference, y, x, frame), dark-subtracted; or a DataArray with these names, in any order
    dials_deg   (frame, 2): of two turning retarders, whose few numbers are fitted; None: a grid of states, the eigenvalue
                method refined. fit_..., retardance_deg, dial_sense, polarizer_near_deg and noise are as for mmbrdf.calibrate()
    saturation  a pixel with a reading at or above it, of whatever reference, is not finite, and fails
    mask        truth values (y, x): False is left out
    start       the instrument to start from, of the same references; None: that of the median of all good pixels
    most_misfit chi squared per degree of freedom above which a pixel has failed

    Each pixel has its own states, brightness, and properties of the references. Pixels that fail are NaN, and
    PixelInstrument.failure says why. Raises ValueError where the median of the image cannot be calibrated, and for shapes
    that do not fit.
    """
    given = _given_references(references)
    array = _stacks(stacks)
    if array.ndim != 4 or array.shape[0] != len(given):
        raise ValueError(f"stacks: shape {array.shape}, expected (reference, y, x, frame) with {len(given)} references")
    dials = None if dials_deg is None else np.asarray(dials_deg, float)
    frames = generator_states * analyzer_states if dials is None else len(dials)
    if array.shape[-1] != frames:
        raise ValueError(f"stacks: the last axis has {array.shape[-1]} frames, expected {frames}")
    shape = array.shape[1:3]
    mask = _plain("mask", mask, ("y", "x", "frame"), ("y", "x"))
    saturation = _saturation(saturation)
    if saturation is not None:
        array = np.where((array >= saturation).any(axis=(0, 3), keepdims=True), np.float32(np.nan), array)
    use = np.ones(shape, bool) if mask is None else np.asarray(_mask_for(mask, array[0]))
    law = {"relative": 1e-3} if noise is None else dict(noise)
    _variance(law, np.zeros(1))
    cameras = _mmbrdf._Cameras(
        [tuple(reference) for reference in given], generator_states, analyzer_states, wavelength_nm,
        (law.get("dark", 0.0), law.get("shot", 0.0), law.get("relative", 0.0)), dial_sense, fit_polarizer_phase,
        dials, retardance_deg, polarizer_near_deg, fit_extinction, fit_diattenuation, fit_drift,
    )  # fmt: skip
    if start is None:
        good = use & np.isfinite(array).all(axis=(0, 3))
        if not good.any():
            raise ValueError("stacks: no pixel that is not masked has finite readings in all frames")
        start = cameras.start(np.stack([np.median(one[good], axis=0).astype(float) for one in array]))
    found = _each_pixel(cameras, start, array, use, most_misfit, threads, progress)
    if "retarders" in found:
        for name in ("retarders", "u_retarders"):
            found[name][..., [0, 1, 2, 4, 5, 6]] = np.degrees(found[name][..., [0, 1, 2, 4, 5, 6]])
    pairs = start.polarimeter.pairs
    return PixelInstrument(found.pop("generator"), found.pop("analyzer"), pairs=pairs, values=found, start=start)


def _each_pixel(
    cameras: Any,
    start: Calibration,
    array: NDArray[Any],
    use: NDArray[np.bool_],
    most_misfit: float,
    threads: int,
    progress: Any,
) -> dict[str, NDArray[Any]]:
    places = np.argwhere(use)
    at_once = 4096
    blocks: Iterable[int] = range(0, len(places), at_once)
    found: dict[str, NDArray[Any]] = {}
    for first in blocks if progress is None else progress(blocks):
        y, x = places[first : first + at_once].T
        some = np.ascontiguousarray(np.moveaxis(array[:, y, x], 0, 1))
        for name, values in cameras.calibrate(start, some, threads, most_misfit).items():
            if name not in found:
                empty = np.uint8(FAILURES.index("masked")) if name == "failure" else np.nan
                found[name] = np.full((*use.shape, *values.shape[1:]), empty, values.dtype)
            found[name][y, x] = values
    if not found:
        raise ValueError("mask: no pixel is left")
    return found


class Simulated(NamedTuple):
    """What simulate() gives: the truth of an imaging polarimeter and of a sample before it."""

    instrument: PixelInstrument
    mueller: NDArray[np.float64]
    """(y, x, 4, 4) of the sample."""
    references: tuple[Reference, ...]
    stacks: NDArray[np.float32]
    """(reference, y, x, frame), with noise."""
    stack: NDArray[np.float32]
    """(y, x, frame) of the sample, with noise."""


def _varying(shape: tuple[int, int], size: float, generator: np.random.Generator) -> NDArray[np.float64]:
    """A smooth number in each pixel, within about +-size."""
    y, x = np.meshgrid(np.linspace(-1, 1, shape[0]), np.linspace(-1, 1, shape[1]), indexing="ij")
    a, b, c, d = generator.normal(0, 0.4, 4)
    return np.asarray(size * (a * x + b * y + c * x * y + d * (x**2 - y**2)))


def _sample(shape: tuple[int, int]) -> NDArray[np.float64]:
    """Stripes and rings: a depolarizing retarder whose axis turns, with a diattenuation at edges."""
    y, x = np.meshgrid(np.linspace(-1, 1, shape[0]), np.linspace(-1, 1, shape[1]), indexing="ij")
    axis = np.degrees(np.arctan2(y, x)) / 2
    retarder = np.asarray(_mmbrdf.retarder(20 + 60 * np.hypot(x, y), axis))
    depolarizing = np.zeros((*shape, 4, 4))
    depolarizing[..., 0, 0] = 1
    for k, power in ((1, 0.9), (2, 0.85), (3, 0.8)):
        depolarizing[..., k, k] = power * (0.75 + 0.25 * np.cos(6 * x) * np.cos(4 * y))
    edge = np.exp(-(((np.hypot(x, y) - 0.6) / 0.1) ** 2))
    polarizing = (1 - 0.3 * edge)[..., None, None] * np.eye(4) + (0.6 * edge)[..., None, None] * np.asarray(
        _mmbrdf.polarizer(axis)
    )
    return np.asarray(depolarizing @ retarder @ polarizing * (0.3 + 0.5 * (np.cos(3 * x + y) + 1) / 2)[..., None, None])


def simulate(
    shape: tuple[int, int],
    *,
    dials_deg: ArrayLike | None = None,
    repeats: int = 18,
    noise: float = 1e-3,
    seed: int = 0,
) -> Simulated:
    """An imaging polarimeter whose retardances, azimuths and leakage vary over the image, its references, and a sample.

    dials_deg  (frame, 2): of two turning retarders; None: a grid of four states in each arm
    repeats    references of each kind: empty, polarizers and wafers of a grid; empty alone of retarders
    noise      relative standard deviation of each reading
    """
    if len(shape) != 2 or min(shape) < 1:
        raise ValueError(f"shape = {tuple(shape)}, expected (y, x), each 1 or more")
    random = np.random.default_rng(seed)
    retardance, turn = 1 + _varying(shape, 0.02, random), _varying(shape, 1.0, random)
    leak = 1e-4 * (1 + _varying(shape, 1.0, random)) ** 2
    bright = 1 + _varying(shape, 0.2, random)

    behind = np.asarray(_mmbrdf.polarizer(0.0, leak))[:, :, None]

    def states(dials: NDArray[Any], of_plate: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Of generator and analyzer: a polarizer and behind it a plate at each dial; the analyzer mirrors it."""
        plate = np.asarray(_mmbrdf.retarder(of_plate * retardance[..., None], dials + turn[..., None]))
        return (plate @ (2 * behind[..., 0, None]))[..., 0], (behind[..., :1, :] @ plate)[..., 0, :]

    pairs = None
    if dials_deg is None:
        grid = np.array([-51.69, -15.12, 15.12, 51.69])
        generator, analyzer = states(grid, 131.81)
    else:
        turned = np.asarray(dials_deg, float)
        generator, analyzer = states(turned[:, 0], 90.0)[0], states(turned[:, 1], 90.0)[1]
        pairs = np.stack([np.arange(len(turned))] * 2, axis=1)
    analyzer = analyzer * bright[..., None, None]
    instrument = PixelInstrument(generator, analyzer, pairs=pairs)
    references, matrices = _simulated_references(repeats if dials_deg is None else 0, max(2, repeats))

    def seen(mueller: NDArray[Any]) -> NDArray[np.float32]:
        exact = readings(np.broadcast_to(mueller, (*shape, 4, 4)), instrument)
        return np.asarray(exact * (1 + noise * random.normal(size=exact.shape)), np.float32)

    sample = _sample(shape)
    return Simulated(instrument, sample, references, np.stack([seen(m) for m in matrices]), seen(sample))


def _simulated_references(others: int, empty: int) -> tuple[tuple[Reference, ...], list[NDArray[np.float64]]]:
    references = [Reference("empty")] * (others or empty)
    matrices = [np.eye(4)] * len(references)
    for k in range(others):
        dial = 180 * k / others
        references.append(Reference("polarizer", dial))
        matrices.append(0.8 * np.asarray(_mmbrdf.polarizer(7.0 + dial, 1e-4)))
    film = (1.46, 0.1, 4.15 + 0.044j)
    for k in range(others):
        angle = 30 + 40 * k / others
        m = np.asarray(_mmbrdf.film_reflection(film, 532.0, angle))
        references.append(Reference("wafer", angle, 1 if m[0, 1] > 0 else -1, 1 if m[3, 2] > 0 else -1))
        matrices.append(m)
    return tuple(references), matrices
