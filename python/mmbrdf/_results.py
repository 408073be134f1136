# SPDX-License-Identifier: BSD-3-Clause
"""What questions and measurements give, beside arrays: named tuples, so that a sequence of them makes a table."""

from __future__ import annotations

import enum as _enum
from typing import Any as _Any
from typing import NamedTuple as _NamedTuple

import numpy as _np

_Array = _np.ndarray


class Outside(_enum.IntFlag):
    """Which of the fitted ranges a question leaves: what Model.outside() gives."""

    INSIDE = 0
    THETA_I = 1
    THETA_R = 2
    WAVELENGTH = 4
    UNKNOWN_RANGE = 8
    DIRECTIONS = 16
    INTERPOLATED = 32
    NOT_VALID = 64
    """With invalid="nan": it was not asked."""


class Evaluation(_NamedTuple):
    """An answer that is whole: what uncertainty=True gives.

    value     as without it: an array, a number, or PolarizedBrdf of arrays
    u         its standard uncertainty (k = 1), of the same shape
    validity  whether the model was fitted there: a sum of Outside for each question
    """

    value: _Any
    u: _Any
    validity: _Any


class Budget(_NamedTuple):
    """What can be signed, of a number or of many: value +- U.

    parts               standard uncertainty by cause
    u                   of all together
    degrees_of_freedom  effective, by Welch and Satterthwaite; inf where those of all parts are
    k                   of 95 % coverage: of Student's distribution, 2 where the degrees of freedom are infinite
    U                   k u
    """

    parts: dict[str, float | _Array]
    u: float | _Array
    degrees_of_freedom: float | _Array
    k: float | _Array
    U: float | _Array


class CalibrationReference(_NamedTuple):
    """A reference of a calibration, as it was found.

    kind              'empty', 'polarizer', 'wafer' or 'retarder'
    angle_deg         dial of the polarizer, angle of incidence on the wafer, azimuth of the retarder
    gain              of an empty one's readings
    measured          (4, 4), its matrix from its readings
    expected          (4, 4), the matrix that it should have, divided by element 11
    figure_of_merit   root mean square of measured / element 11 - expected over the fifteen other elements
    """

    kind: str
    angle_deg: float
    gain: float
    measured: _Array
    expected: _Array
    figure_of_merit: float
