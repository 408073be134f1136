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

from .. import _calls
from .._pixel_fits import PixelFit, PixelModels, load_models
from .calibration import Reference, calibrate
from .instruments import FAILURES, PixelInstrument, join
from .matrices import quantities, readings
from .noise import uncertainty
from .reduction import reduce
from .simulation import Simulated, simulate

__all__ = [
    "FAILURES",
    "PixelFit",
    "PixelInstrument",
    "PixelModels",
    "Reference",
    "Simulated",
    "calibrate",
    "join",
    "load_models",
    "quantities",
    "readings",
    "reduce",
    "simulate",
    "uncertainty",
]

_calls.tell_in_a_line(globals(), __all__, "images")
