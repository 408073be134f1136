# SPDX-License-Identifier: BSD-3-Clause
"""What noise of the frames makes of matrices and quantities."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _chunks, _mmbrdf
from .._arguments import nan_where_masked, number
from .._mmbrdf import Polarimeter
from .._signatures import MATRIX
from .instruments import PixelInstrument, _core_shape, _Instrument, _polarimeter
from .stacks import _ROWS_AT_ONCE, _checked, _named_axes


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
    if not _chunks.is_lazy(stack):
        array = nan_where_masked(stack, np.float32)
        _checked(array, own)
        return work(array)
    _checked(stack, own)
    _chunks.require_whole("stack", stack, ("frame",))
    if isinstance(own, PixelInstrument):
        raise TypeError("stack: uncertainties of a PixelInstrument take numpy arrays: go through rows of the image")
    return _chunks.by_chunk(work, [stack], [("frame",)], () if quantity else MATRIX, _chunks.SIZES, np.float32)


class _Noise:
    function = "uncertainty"  # as Dask shows it

    def __init__(self, own: Polarimeter | PixelInstrument, noise: dict[str, float], quantity: str | None):
        self.own, self.noise, self.quantity = own, noise, quantity

    def __call__(self, stack: NDArray[Any]) -> NDArray[Any]:
        stack = nan_where_masked(stack, np.float32)
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
