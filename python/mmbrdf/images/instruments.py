# SPDX-License-Identifier: BSD-3-Clause
"""An instrument for each pixel of an image."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _mmbrdf
from .._arguments import nan_where_masked, unmasked
from .._mmbrdf import Calibration, Polarimeter

FAILURES = ("", "not finite", "no convergence", "misfit", "dependent states", "masked")
"""What the numbers of PixelInstrument.failure mean: 0 is a calibrated pixel."""


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
        self.generator = np.asarray(nan_where_masked(generator, float), float)
        self.analyzer = np.asarray(nan_where_masked(analyzer, float), float)
        for name, array in (("generator", self.generator), ("analyzer", self.analyzer)):
            if array.ndim != 4 or array.shape[-1] != 4:
                raise ValueError(f"{name}: shape {array.shape}, expected (y, x, states, 4)")
        if self.generator.shape[:2] != self.analyzer.shape[:2]:
            raise ValueError(
                f"generator: {self.generator.shape[:2]} pixels, analyzer: {self.analyzer.shape[:2]}: axes y and x differ"
            )
        self.pairs = None if pairs is None else np.asarray(unmasked("pairs", pairs), np.int64)
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
