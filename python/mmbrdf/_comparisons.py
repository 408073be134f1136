# SPDX-License-Identifier: BSD-3-Clause
"""What comparing models and samples gives: named tuples, so that a sequence of them makes a table."""

from __future__ import annotations

from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import NamedTuple as _NamedTuple

if _TYPE_CHECKING:
    from . import Geometry


class Difference(_NamedTuple):
    """Of one quantity over all samples: largest is without sign, and stands where it is."""

    rms: float
    mean: float
    largest: float
    wavelength_nm: float
    theta_i_deg: float
    phi_i_deg: float
    theta_r_deg: float
    phi_r_deg: float


class Significance(_NamedTuple):
    """Differences of two models over their uncertainty, that of independent fits.

    samples       where that is not 0
    mean          of |difference| / u: 0.8 for fits of one sample that are as uncertain as they say
    largest       of |difference| / u, at wavelength_nm and geometry
    within        share within 1.96 u
    """

    samples: int
    mean: float
    largest: float
    wavelength_nm: float
    geometry: Geometry
    within: float


class Comparison(_NamedTuple):
    """Samples, or a second model, minus a model.

    dark               of the samples: f11 of the model is not positive, and f11 alone is compared
    f11, f11_relative  in sr^-1, and divided by f11 of the model
    normalized         of the 15 f_ij / f11, by element: comparison.normalized['22'].rms
    polarization_rms   root mean square over those
    largest            of all differences, relative to f11
    significance       Significance of two models by element ('11' is f11); None: not known, or samples
    """

    samples: int
    dark: int
    f11: Difference
    f11_relative: Difference
    normalized: dict[str, Difference]
    polarization_rms: float
    largest: Difference
    significance: dict[str, Significance] | None = None

    def __repr__(self) -> str:
        found = f"rms of f11 {self.f11.rms:.3g} sr^-1, of the other elements {self.polarization_rms:.3g}"
        return (
            f"<mmbrdf.Comparison: {self.samples} samples, {found}, largest difference / f11 {self.largest.largest:.3g}>"
        )
