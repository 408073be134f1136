# SPDX-License-Identifier: BSD-3-Clause
"""Images of matrices: what a camera reads of them, and their quantities."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _mmbrdf
from .._arguments import nan_where_masked
from .._mmbrdf import Polarimeter
from .instruments import PixelInstrument, _Instrument, _polarimeter
from .stacks import _by_name


def readings(mueller: ArrayLike, instrument: _Instrument) -> NDArray[np.float64]:
    """The stack (y, x, frame) that matrices (y, x, 4, 4) give, without noise."""
    own = _polarimeter(instrument)
    if isinstance(own, PixelInstrument):
        mueller = _by_name("mueller", mueller, ("y", "x", "row", "column"))
    m = np.asarray(nan_where_masked(mueller, float), float)
    if isinstance(own, Polarimeter):
        return np.asarray(own.readings(m)).reshape(*m.shape[:-2], -1)
    if m.shape != (*own.shape, 4, 4):
        raise ValueError(f"mueller: shape {m.shape}, expected {(*own.shape, 4, 4)}")
    if own.pairs is None:
        grid = np.einsum("yxqi,yxij,yxpj->yxqp", own.analyzer, m, own.generator, optimize=True)
        return grid.reshape(*own.shape, -1)
    w, a = own.generator[:, :, own.pairs[:, 0]], own.analyzer[:, :, own.pairs[:, 1]]
    return np.einsum("yxfi,yxij,yxfj->yxf", a, m, w, optimize=True)


def quantities(mueller: Any, names: Sequence[str]) -> Any:
    """Some of mmbrdf.quantities() of an image of matrices: {name: (y, x)}, NaN where one has none.

    Of a DataArray an xarray.Dataset. Raises ValueError for a name that there is not, and for one that takes light.
    """
    known = {q.name for q in _mmbrdf.quantities() if not q.takes_light}
    package = sys.modules["mmbrdf"]
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
