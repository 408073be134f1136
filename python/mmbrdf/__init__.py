# SPDX-License-Identifier: BSD-3-Clause
"""Mueller-matrix BRDFs: fit them to measurements, evaluate them anywhere, with an uncertainty on every number.

    import mmbrdf
    ptfe = mmbrdf.material("ptfe")
    f = ptfe.evaluate(532, theta_i_deg=45, phi_i_deg=0, theta_r_deg=[0, 30, 60], phi_r_deg=180)     # (3, 4, 4), sr^-1

Angles are in degrees, wavelengths in nanometres, and the names of arguments say so. Directions point away from the
sample; azimuths are counted from x towards y; the frame of a matrix is named (xy, sp or scattering_plane). Arrays
broadcast as numpy's do. ValueError is for arguments that make no sense, OSError for files.
"""

from __future__ import annotations

import importlib as _importlib
import os as _os
from collections.abc import Mapping as _Mapping
from collections.abc import Sequence as _Sequence
from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import Any as _Any
from typing import NamedTuple as _NamedTuple

import numpy as _np

from . import _asking, _calls, _lazy, _mmbrdf, _summaries

_calls.install(_mmbrdf, _asking.answering(_mmbrdf))
_asking.install(_mmbrdf)
_summaries.install(_mmbrdf)

from ._choices import *  # noqa: F403: what choosing gives
from ._comparisons import *  # noqa: F403: what comparing gives
from ._judgements import *  # noqa: F403: what judging gives
from ._mmbrdf import *  # noqa: F403: the names of the library
from ._mmbrdf import Dataset as Dataset
from ._mmbrdf import Model as Model
from ._mmbrdf import __version__ as __version__
from ._mmbrdf import _holds_samples
from ._mmbrdf import load_model as load_model
from ._mmbrdf import read_samples as read_samples
from ._results import *  # noqa: F403: what questions give
from ._transfer import py6s_surface as py6s_surface
from ._transfer import pythonic_disort_modes as pythonic_disort_modes
from ._warnings import ExtrapolationWarning as ExtrapolationWarning
from ._warnings import InstrumentWarning as InstrumentWarning

if _TYPE_CHECKING:
    from . import plot as plot

_Array = _np.ndarray


class Geometry(_NamedTuple):
    """Directions of many questions, in degrees: arrays that broadcast. model.evaluate(532, *geometry)"""

    theta_i_deg: _Array
    phi_i_deg: _Array
    theta_r_deg: _Array
    phi_r_deg: _Array


class SampledDirections(_NamedTuple):
    """Scattered directions that were drawn: what DirectionSampler.sample() gives. Arrays of one shape."""

    theta_r_deg: _Array
    phi_r_deg: _Array
    pdf: _Array
    """Per solid angle, sr^-1."""


class FourierMoments(_NamedTuple):
    """Moments of a Mueller BRDF in azimuth: what Model.fourier_moments() gives. Arrays [mu_r, mu_i, m, row, column]."""

    cosine: _Array
    sine: _Array


class PolarizedBrdf(_NamedTuple):
    """BRDFs between linear polarizations; the first letter is the incident one. Arrays of one shape."""

    ss: _Array
    sp: _Array
    ps: _Array
    pp: _Array


class Quantity(_NamedTuple):
    """A number that is derived from a Mueller matrix, and from incident light if it takes some."""

    name: str
    unit: str
    meaning: str
    takes_light: bool


class Analyzed(_NamedTuple):
    """A quantity at many geometries: what Model.analyze() gives. Arrays of one shape."""

    value: _Array
    u: _Array
    """Standard uncertainty (k = 1)."""
    parts: dict[str, _Array]
    """u in first order of the fit alone, and of each term alone: their squares add up."""
    low: _Array
    """With draws: low to high hold 95 % of them."""
    high: _Array


class CloudeDecomposition(_NamedTuple):
    """M = sum of weights (..., 4), falling, times components (..., 4, 4, 4) that do not depolarize."""

    weights: _Array
    components: _Array


class LuChipman(_NamedTuple):
    """M = depolarizer @ retarder @ diattenuator, each (..., 4, 4)."""

    depolarizer: _Array
    retarder: _Array
    diattenuator: _Array


class SymmetricDecomposition(_NamedTuple):
    """M = diattenuator2 @ retarder2 @ depolarizer @ retarder1.T @ diattenuator1, each (..., 4, 4)."""

    diattenuator2: _Array
    retarder2: _Array
    depolarizer: _Array
    retarder1: _Array
    diattenuator1: _Array


@_calls.told_in_a_line("load")
def load(path: str | _os.PathLike[str]) -> Model | Dataset:
    """A Model from a model file or published coefficients, a Dataset from a file of samples.

    Files of samples are CSV with a header line; coefficients have none; model files are JSON. Raises OSError for a file
    that cannot be read, and with line or field for one that holds something else.
    """
    return read_samples(path) if _holds_samples(path) else load_model(path)


@_calls.told_in_a_line("report")
def _write_report(
    model: Model | None,
    data: Dataset | None,
    path: str | _os.PathLike[str],
    *,
    name: str = "",
    data_name: str = "samples",
    wavelength_nm: float | _Sequence[float] | None = None,
    theta_i_deg: float = 45,
    notation: str = "brackets",
    paper: str = "a4",
    model_file: str | _os.PathLike[str] | None = None,
    data_file: str | _os.PathLike[str] | None = None,
    terms: _Mapping[str, float] | _Sequence[str] | None = None,
    format: str | None = None,
) -> None:
    """Writes what `mmbrdf report` says of a model, and of samples beside it, as the ending of ``path`` says: .html, one
    self-contained page with pictures, .pdf, the same printed by Chromium, .md or .json. Without a model, None, what `mmbrdf
    inspect` says of samples before they are fitted, with pictures: .html or .pdf.

    name, data_name  what the model and the samples are called
    wavelength_nm    at which to report; None: at those it was fitted to, or else those of the samples; without a model: all
    theta_i_deg      angle of incidence of the pictures of the model
    notation         "brackets", as in 0.98412(32), or "plus-minus", as in 0.98412 ± 0.00032
    paper            of a PDF: "a4" or "letter"
    model_file, data_file
                     the files that they were read from: their names and SHA-256 are in the report; without the latter, the SHA-256
                     is that of the samples as Dataset.save() writes them
    terms            of type B, added to all u: as those of evaluate_uncertainty(), or as `mmbrdf report --term` takes them,
                     ["plaque:scale=0.3%,dof=12"]
    format           "markdown", "html", "pdf" or "json", whatever the ending

    It has the date, or that of SOURCE_DATE_EPOCH. Needs matplotlib but for .md and .json; .pdf needs Chromium, or what
    MMBRDF_BROWSER names. Raises TypeError for what is not a model and samples, ValueError for another ending, for samples that do
    not go with the model, and where there is no Chromium, OSError for a path that cannot be written; then an earlier file is left
    as it was.
    """
    from . import _report

    kind = _report.kind_of(path, format)
    _report.require_folder(path)
    source = _report.Source(
        model,
        data,
        name,
        data_name,
        wavelength_nm,
        theta_i_deg,
        model_file=model_file,
        data_file=data_file,
        terms=terms,
    )
    _report.write(path, _report.made(source, kind, _report.Look(notation, paper)))


report = _write_report


def __getattr__(name: str) -> _Any:
    """mmbrdf.plot is there without an import of its own; matplotlib is not imported before."""
    if name == "plot":
        return _importlib.import_module(".plot", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), "plot"})


_lazy.install(globals())

from . import images as images  # noqa: E402: of what is above
