# SPDX-License-Identifier: BSD-3-Clause
"""Names in pictures: they are text that others chose, and matplotlib must not read them as formulas."""
from __future__ import annotations

import contextlib
import logging
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

import mmbrdf


def plain(name: str) -> str:
    """A name as matplotlib shows it letter by letter, also in a legend, which passes over labels that begin with _."""
    return (" " if name.startswith("_") else "") + name.replace("$", r"\$")


def not_fitted(source: Any, wavelength_nm: float | None, theta_i_deg: float = 0.0) -> str:
    """ ", beyond the fit" or ", interpolated", of a model that is asked at another wavelength or source than it was fitted to."""
    if wavelength_nm is None or not isinstance(source, mmbrdf.Model):
        return ""
    outside = mmbrdf.Outside(int(np.max(source.outside(wavelength_nm, theta_i_deg, 0, 0, 0))))
    if (mmbrdf.Outside.WAVELENGTH | mmbrdf.Outside.THETA_I) & outside:
        return ", beyond the fit"
    return ", interpolated" if mmbrdf.Outside.INTERPOLATED in outside else ""


def title(
    name: str,
    wavelength_nm: float | None,
    theta_i_deg: float | None = None,
    frame: str | None = None,
    source: Any = None,
) -> str:
    """What is shown, as plain() gives it, at which wavelength and angle of incidence, in which frame: what of this is known;
    and whether a model that is the ``source`` was fitted there."""
    wavelength = "" if wavelength_nm is None else f"{wavelength_nm:g} nm{not_fitted(source, wavelength_nm)}"
    angle = "" if theta_i_deg is None else rf"$\theta_\mathrm{{i}}$ = {theta_i_deg:g}°"
    if theta_i_deg is not None and not not_fitted(source, wavelength_nm):
        angle += not_fitted(source, wavelength_nm, theta_i_deg)
    axes = "" if frame is None else f"frame {frame.replace('_', ' ')}"
    return ", ".join(part for part in (name, wavelength, angle, axes) if part)


_UNITS = {"sr^-1": "sr$^{-1}$", "deg": "°"}


def quantity(symbol: str, unit: str) -> str:
    """A label as SI has it, the quantity divided by its unit: ``f / sr$^{-1}$``. No unit: the symbol alone."""
    return f"{symbol} / {_UNITS.get(unit, unit)}" if unit else symbol


_SAYS_WHAT_FONTS_LACK = logging.getLogger("matplotlib.mathtext")
"""For names that stand beside a formula; for others it is a warning."""


def _is_of_something_else(record: logging.LogRecord) -> bool:
    return "does not have a glyph" not in record.getMessage()


@contextlib.contextmanager
def _whatever_the_font_lacks() -> Iterator[None]:
    _SAYS_WHAT_FONTS_LACK.addFilter(_is_of_something_else)
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", r"Glyph \d+ .*missing from", UserWarning)
            yield
    finally:
        _SAYS_WHAT_FONTS_LACK.removeFilter(_is_of_something_else)


class Picture(Figure):
    """A figure that draws a box for each character that its font lacks, as all do, but says nothing of each.

    Its hatches are thin, and what it saves as PDF has its fonts as TrueType, which publishers ask for.
    """

    def draw(self, renderer: Any) -> None:
        with _whatever_the_font_lacks(), rc_context({"hatch.linewidth": 0.5}):
            super().draw(renderer)

    def savefig(self, fname: Any, **options: Any) -> None:
        with rc_context({"pdf.fonttype": 42, "ps.fonttype": 42}):
            super().savefig(fname, **options)

    def get_tightbbox(self, *arguments: Any, **options: Any) -> Any:
        with _whatever_the_font_lacks():
            return super().get_tightbbox(*arguments, **options)
