# SPDX-License-Identifier: BSD-3-Clause
"""What choosing a model or a measurement gives: named tuples, so that a sequence of them makes a table.

    pandas.DataFrame(mmbrdf.select(data).f11)
"""

from __future__ import annotations

from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import NamedTuple as _NamedTuple

import numpy as _np

if _TYPE_CHECKING:
    from . import PolarizedBrdf

_Array = _np.ndarray


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
