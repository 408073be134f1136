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
    """Differences d of one element over their standard uncertainty u, that of independent measurements.

    samples  where u is known, and not 0
    u        root mean square: of f11 in sr^-1, of the other elements divided by it
    rms      of d / u: 1 if they differ by chance
    mean     of |d| / u: then 0.8
    largest  of |d| / u, at wavelength_nm and geometry
    within   share within 1.96 u: then 0.95
    beyond   share beyond 2 u: then 0.046
    """

    samples: int
    u: float
    rms: float
    mean: float
    largest: float
    wavelength_nm: float
    geometry: Geometry
    within: float
    beyond: float


class Comparison(_NamedTuple):
    """Samples, or a second model, minus a model.

    dark               of the samples: f11 of the model is not positive, and f11 alone is compared
    f11, f11_relative  in sr^-1, and divided by f11 of the model
    normalized         of the 15 f_ij / f11, by element: comparison.normalized['22'].rms
    polarization_rms   root mean square over those
    largest            of all differences, relative to f11
    significance       Significance by element ('11' is f11); None: the uncertainties of one are not known
    images             of samples beside samples: how many of them are compared by their image
    """

    samples: int
    dark: int
    f11: Difference
    f11_relative: Difference
    normalized: dict[str, Difference]
    polarization_rms: float
    largest: Difference
    significance: dict[str, Significance] | None = None
    images: int = 0

    def __repr__(self) -> str:
        found = f"rms of f11 {self.f11.rms:.3g} sr^-1, of the other elements {self.polarization_rms:.3g}"
        return (
            f"<mmbrdf.Comparison: {self.samples} samples, {found}, largest difference / f11 {self.largest.largest:.3g}>"
        )
