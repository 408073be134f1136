# SPDX-License-Identifier: BSD-3-Clause
"""What choosing, judging and comparing fits gives: named tuples, so that a sequence of them makes a table.

    pandas.DataFrame(mmbrdf.select(data).f11)
"""

from __future__ import annotations

import enum as _enum
from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import Any as _Any
from typing import NamedTuple as _NamedTuple

import numpy as _np

if _TYPE_CHECKING:
    from . import Geometry, PolarizedBrdf

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


class HeldOut(_NamedTuple):
    """How well a candidate predicts what it was not fitted to, each sample without its fold.

    rms           over all samples; None: some fold leaves the model undetermined
    worst         largest rms of one fold
    worst_fold    which: 'fold 2', '30 degrees', '532 nm'
    undetermined  why a fold could not be predicted, and which; '': all could
    """

    rms: float | None
    worst: float | None
    worst_fold: str | None
    undetermined: str


class Candidate(_NamedTuple):
    """A model that select() has tried, of f11 or of the other elements.

    order, powers     highest radial order, highest power of the wavelength
    coefficients      how many it has; rank: how many of their combinations the data determine
    condition         largest condition number of a block
    rms, aic, bic     of the fit to all samples
    cross_validation  HeldOut by what is left out: 'rows' or 'random', 'angle', 'wavelength'
    refused           why it should not be used; None: it may
    """

    order: int
    powers: int
    coefficients: int
    rank: int
    condition: float
    rms: float
    aic: float
    bic: float
    cross_validation: dict[str, HeldOut]
    refused: str | None


class Selection(_NamedTuple):
    """What select() recommends: fit(data, orders=selection.orders, powers=selection.powers).

    orders, powers            None: no recommendation
    f11, other                all candidates, by powers, then by order
    reason_f11, reason_other  of the recommendation, or of there being none
    note                      what the data do not allow to be left out; '': nothing
    """

    orders: tuple[int, int] | None
    powers: int | None
    f11: tuple[Candidate, ...]
    other: tuple[Candidate, ...]
    reason_f11: str
    reason_other: str
    note: str

    def __repr__(self) -> str:
        found = f"orders {self.orders}, powers {self.powers}" if self.orders else "no recommendation"
        note = f"; {self.note}" if self.note else ""
        return f"<mmbrdf.Selection: {found}; f11: {self.reason_f11}; others: {self.reason_other}{note}>"


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


class SubsetSplit(_NamedTuple):
    """One division of the samples: each part is fitted apart.

    seed                of the lot; None: dealt in turn
    curves              f_ss, f_sp, f_ps, f_pp of the fit to each part, in sr^-1
    mean, deviation     of the curves; the standard deviation has as many degrees of freedom as parts, less one
    uncertainty         of the fit to one part, as the covariance of the fit to all samples predicts it
    reference           the fit to all samples, or the model that was given; what follows is relative to it
    mean_deviation      mean of deviation; root_mean_variance: its root mean square
    mean_distance       mean of |mean - 1|; largest_distance: the largest, at largest_at_theta_r_deg
    left_out            angles at which the reference is not positive: what is relative to it leaves them out
    """

    seed: int | None
    curves: tuple[PolarizedBrdf, ...]
    mean: PolarizedBrdf
    deviation: PolarizedBrdf
    uncertainty: PolarizedBrdf
    reference: PolarizedBrdf
    mean_deviation: float
    root_mean_variance: float
    mean_distance: float
    largest_distance: float
    largest_at_theta_r_deg: float
    left_out: int


class Subsets(_NamedTuple):
    """The subset method: what subsets() gives.

    splits       one for each division
    theta_r_deg  (N,), of the curves: positive is forward
    observed     relative standard deviation of the fits, root mean square over all splits
    predicted    the same as the covariance of one fit predicts it
    """

    splits: tuple[SubsetSplit, ...]
    theta_r_deg: _Array
    observed: float
    predicted: float

    def __repr__(self) -> str:
        splits = f"{len(self.splits)} split{'s' * (len(self.splits) > 1)} in {len(self.splits[0].curves)} parts"
        found = f"standard deviation {100 * self.observed:.4g} %, predicted {100 * self.predicted:.4g} %"
        return f"<mmbrdf.Subsets: {splits}, {found}>"


class Plan(_NamedTuple):
    """Expected standard uncertainties before anything is measured: what plan() gives.

    designs   their names; each as it is, and with the sample turned between its readings
    readings  of each
    targets   blocks of elements ("11", in sr^-1, "12_13_21_31", …: root mean square over directions up to 70 degrees),
              then what was asked for: "dhr_45", "f_0_45" in sr^-1
    u         (designs, targets)
    """

    designs: tuple[str, ...]
    readings: tuple[int, ...]
    targets: tuple[str, ...]
    u: _Array

    def __repr__(self) -> str:
        width = max(map(len, self.designs))
        lines = [" " * width + "".join(f"{target:>13}" for target in self.targets)]
        for design, row in zip(self.designs, self.u):
            lines.append(f"{design:{width}}" + "".join(f"{u:13.2g}" for u in row))
        return "\n".join(lines)


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
