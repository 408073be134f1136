# SPDX-License-Identifier: BSD-3-Clause
"""Warnings, and the line that they are of: that of the user, however deep within the package they come up."""

from __future__ import annotations

import os
import sys
import warnings

_HERE = os.path.dirname(os.path.abspath(__file__)) + os.sep


class ExtrapolationWarning(UserWarning):
    """Geometries or wavelengths lie outside what a model was fitted to."""


class InstrumentWarning(UserWarning):
    """An instrument, or what it measured, is doubtful."""


_CATEGORIES = {one.__name__: one for one in (UserWarning, ExtrapolationWarning, InstrumentWarning)}


def warn(text: str, category: str = "UserWarning") -> None:
    """Warns at the line outside of this package that led here."""
    frame, level = sys._getframe(1), 2
    while frame is not None and os.path.abspath(frame.f_code.co_filename).startswith(_HERE):
        frame, level = frame.f_back, level + 1
    warnings.warn(text, _CATEGORIES[category], stacklevel=level)
