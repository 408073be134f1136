# SPDX-License-Identifier: BSD-3-Clause
"""What judging samples, fits and models gives: named tuples, so that a sequence of them makes a table."""

from __future__ import annotations

from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import NamedTuple as _NamedTuple

import numpy as _np

if _TYPE_CHECKING:
    from . import Geometry

_Array = _np.ndarray


class Finding(_NamedTuple):
    """A fault that samples show: inspect().

    fault     'fill values'
    evidence  'f11 = -999 in 20 samples: 3, 17, ...', counted from 1
    remedy    what mends it; '': that depends
    samples   which, counted from 0; (): all, or that depends
    """

    fault: str
    evidence: str
    remedy: str
    samples: tuple[int, ...] = ()


class Untested(_NamedTuple):
    """A fault that inspect() would not have seen, and why.

    fault   'cosine'
    reason  '3 samples, and a fit of low order has 14 coefficients'
    """

    fault: str
    reason: str


class Missing(_NamedTuple):
    """Which share of the pairs of directions no samples support: arrays, nan beyond the angles of the samples, empty if not
    known.

    theta_deg, phi_deg  (N,), (M,) the nodes at which it is known; phi is that between source and detector, 0 to 180
    theta_i             (N,) for each polar angle of the source
    detector            (N, M) for each theta_r and phi of the detector
    """

    theta_deg: _Array
    phi_deg: _Array
    theta_i: _Array
    detector: _Array


class Inspection(_NamedTuple):
    """What samples are, seen before they are fitted.

    findings      what seems to be wrong with them; (): nothing
    f11_residual  rms of f11 - a fit of low order, relative to that of f11: noise and fine structure; 0: no fit
    unsupported   share of the pairs of directions within their angles that no samples support
    hole          where most of these are, in words; '': at most a twentieth
    untested      what else might be wrong, for all that these samples say
    hole_deg      and in numbers: 'theta_i', 'theta_r', 'phi_r_phi_i' (without sign), each from one angle to another, if more
                  than half is missing there and not everywhere
    missing       the same for each direction: Missing
    residuals     f11 - that fit of each sample, in sr^-1; nan: other wavelengths, and fill values
    rows          what `mmbrdf inspect` says the samples are: names and texts
    verdict       'nothing seems to be wrong'; '' with findings
    """

    findings: tuple[Finding, ...]
    f11_residual: float
    unsupported: float
    hole: str
    untested: tuple[Untested, ...]
    hole_deg: dict[str, tuple[float, float]]
    missing: Missing
    residuals: _Array
    rows: dict[str, str]
    verdict: str

    def __repr__(self) -> str:
        found = ", ".join(one.fault for one in self.findings) or self.verdict
        untested = ", ".join(one.fault for one in self.untested)
        return f"<mmbrdf.Inspection: {found}{'; cannot be told: ' * bool(untested)}{untested}>"


class FTest(_NamedTuple):
    """Whether a block of modes explains more without a symmetry.

    rows, extra, freedom  how many rows, coefficients that come in without it, and degrees of freedom are left then
    rms, rms_extended     with and without the symmetry
    f, p                  the ratio, and the probability of one as large from data that have the symmetry
    """

    block: str
    rows: int
    extra: int
    freedom: int
    rms: float
    rms_extended: float
    f: float
    p: float


class SymmetryTests(_NamedTuple):
    """FTest of each block: without reciprocity, without mirror symmetry, and with a dependence on phi_i.

    one_azimuth  the source has one azimuth: `azimuth` is empty, and whether the sample is isotropic cannot be told
    """

    reciprocity: tuple[FTest, ...]
    mirror: tuple[FTest, ...]
    azimuth: tuple[FTest, ...]
    one_azimuth: bool


class Leverage(_NamedTuple):
    """How much each sample determines of a block: `values` (N,) add up to the rank; `largest` is a sample's number."""

    block: str
    rank: int
    values: _Array
    largest: int


class SampleDiagnostics(_NamedTuple):
    """Leverage by block, and studentized residuals (N, 4, 4): near normal with variance 1 if the weights are right."""

    leverage: tuple[Leverage, ...]
    studentized: _Array


class Outlier(_NamedTuple):
    """A sample, counted from 0, and the element of it ('22') that lies `studentized` standard deviations off."""

    sample: int
    element: str
    studentized: float


class MirrorPairs(_NamedTuple):
    """Samples that are each other's mirror image in the plane of incidence.

    pairs  how many there are
    rms    (4, 4) of their differences over 2^0.5: noise of one sample, and broken symmetry; of f11 relative
    mean   (4, 4), half the mean difference: 0 but for noise / (2 pairs)^0.5
    """

    pairs: int
    rms: _Array
    mean: _Array


class ModelDiagnostics(_NamedTuple):
    """Where a model is not physical, on a grid of directions up to theta_max_deg.

    margin, margin_at            smallest coherency eigenvalue / f11, and where; unrealizable: how many are negative;
                                 nan and None where elements were not measured
    f11, f11_at                  smallest, in sr^-1; not_positive_f11: how many are not positive
    dhr, dhr_theta_i_deg         largest directional-hemispherical reflectance, and its angle of incidence
    """

    wavelength_nm: float
    theta_max_deg: float
    geometries: int
    margin: float
    margin_at: Geometry
    unrealizable: int | None
    f11: float
    f11_at: Geometry
    not_positive_f11: int
    dhr: float
    dhr_theta_i_deg: float
