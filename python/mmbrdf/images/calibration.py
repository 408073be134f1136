# SPDX-License-Identifier: BSD-3-Clause
"""The calibration of each pixel, from references before the camera."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _mmbrdf
from .._arguments import nan_where_masked, unmasked
from .._mmbrdf import Calibration
from .instruments import FAILURES, PixelInstrument
from .noise import _variance
from .stacks import _by_name, _mask_for, _plain, _saturation


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


def _given_references(references: Sequence[Reference | tuple[Any, ...]]) -> list[Reference]:
    result = [Reference(*reference) for reference in references]
    if not result:
        raise ValueError("references: none")
    return result


def _stacks(stacks: Any) -> NDArray[np.float32]:
    """As (reference, y, x, frame), by names where there are some."""
    image = ("y", "x", "frame")
    if isinstance(stacks, list | tuple):
        return np.asarray([nan_where_masked(_by_name("stacks", one, image), np.float32) for one in stacks], np.float32)
    return np.asarray(nan_where_masked(_by_name("stacks", stacks, ("reference", *image)), np.float32), np.float32)


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
    dials = None if dials_deg is None else np.asarray(unmasked("dials_deg", dials_deg), float)
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
