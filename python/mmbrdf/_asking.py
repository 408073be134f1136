# SPDX-License-Identifier: BSD-3-Clause
"""What all questions to a model may say besides: that nan is asked of what is nan, that u and validity come along, that the answer
has names.

Each of these is done once here, around the compiled functions: what is not valid is left out of the question, and nan is put in its
place in the answer.
"""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from . import _calls
from ._arguments import joined_masks, nan_where_masked
from ._results import Evaluation, Outside
from ._warnings import ExtrapolationWarning

_ANGLES = ("theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg")
_QUESTION = ("wavelength_nm", *_ANGLES)
_LIGHT = ("stokes", "analyzer")
_CORES = {"stokes": (4,), "analyzer": (4,), "mueller": (4, 4)}
"""The last axes of what is not a number for each question."""


class Question(NamedTuple):
    """How a function is asked.

    uncertainty  the function that has u of the same arguments, as the compiled part calls it; None: there is none
    labelled     the quantity, with as_xarray; None: it has no names
    leading      how many axes stand before those of the questions
    apertures    it is asked of a source and a receiver: the value is the first of what it gives, and nothing of it is nan
    """

    uncertainty: str | None = None
    labelled: str | None = None
    leading: int = 0
    apertures: bool = False


QUESTIONS = {
    "Model.evaluate": Question("Model.evaluate_uncertainty", "brdf"),
    "Model.evaluate_uncertainty": Question(labelled="uncertainty"),
    "Model.reflectance_factor": Question("Model.reflectance_factor_uncertainty", "reflectance_factor"),
    "Model.reflectance_factor_uncertainty": Question(),
    "Model.covariance": Question(),
    "Model.evaluate_draws": Question(leading=1),
    "Model.predict_readings": Question(),
    "Model.outside": Question(),
    "Model.estimable": Question(),
    "Model.analyze": Question(labelled="analysis"),
    "DirectionSampler.weight": Question(),
    "change_frame": Question(),
    "directional_hemispherical_reflectance": Question("directional_hemispherical_uncertainty", "dhr"),
    "directional_hemispherical_uncertainty": Question(),
    "hemispherical_directional_reflectance": Question("hemispherical_directional_uncertainty", "hdr"),
    "hemispherical_directional_uncertainty": Question(),
    "bihemispherical_reflectance": Question("bihemispherical_uncertainty", "bhr"),
    "bihemispherical_uncertainty": Question(),
    "average": Question("average_uncertainty", apertures=True),
    "polarized_curve": Question("polarized_uncertainty"),
    "polarized_uncertainty": Question(),
}

_MORE = {
    "uncertainty": "uncertainty  True: Evaluation(value, u, validity) in the place of the value; u as terms has it",
    "terms": "terms        of type B in u, as those of evaluate_uncertainty()",
    "invalid": "invalid      'nan': nan for what is asked of nan, of a polar angle beyond 90 degrees, and of what is masked; "
    "validity\n             says so, as outside() does. 'raise': an error",
    "as_xarray": "as_xarray    an xarray.DataArray with named axes, units and conventions, which to_netcdf() can write; a Dataset "
    "with\n             u and validity if there are several",
}


# ---- what is not valid -----------------------------------------------------------------------------------------------


def _numbers(value: Any) -> np.ndarray | None:
    """As an array of float, nan where it is masked; None for what is none, which the compiled part refuses."""
    array = np.ma.asanyarray(value) if isinstance(value, np.ma.MaskedArray) else np.asarray(value)
    if array.dtype.kind not in "biuf":
        return None
    if isinstance(array, np.ma.MaskedArray):
        return array.astype(float).filled(np.nan)
    return array.astype(float)


def _is_valid(name: str, array: np.ndarray) -> np.ndarray:
    """Of each question; light has four numbers."""
    if name in _LIGHT:
        return np.isfinite(array).all(axis=-1)
    if name == "mueller":  # of which nan is what was not measured
        return np.ones(array.shape[:-2], bool)
    if name == "wavelength_nm":
        return (array > 0) & (array <= 1e9)  # a metre
    with np.errstate(invalid="ignore"):
        return np.isfinite(array) & ((np.abs(array) <= 90) | (not name.startswith("theta")))


def _question(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """What of the arguments broadcasts. The directions of a geometry stand one behind the other."""
    names = (*_QUESTION, *_CORES, "pdf")
    question = {name: joined_masks(arguments[name]) for name in names if arguments.get(name) is not None}
    if "source" in arguments:  # of apertures: where they reach
        question["theta_i_deg"] = arguments["source"].largest_theta_deg
        question["theta_r_deg"] = arguments["receiver"].largest_theta_deg
    if "geometry" in arguments:
        angles = [np.ma.asanyarray(joined_masks(one)) for one in arguments["geometry"]]
        shape = np.broadcast_shapes(*(one.shape for one in angles))
        question.update(zip(_ANGLES, (np.ma.masked_array(*_whole(one, shape)).ravel() for one in angles)))
    return question


def _whole(array: np.ma.MaskedArray, shape: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
    return np.broadcast_to(array.data, shape), np.broadcast_to(np.ma.getmaskarray(array), shape)


def _put(arguments: Mapping[str, Any], question: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments with this question."""
    if "geometry" in arguments:
        return {**arguments, "geometry": [question[name] for name in _ANGLES]}
    return {**arguments, **question}


class _Left(NamedTuple):
    """What is left of a question without what is not valid."""

    question: dict[str, np.ndarray]
    valid: np.ndarray

    def put_back(self, result: Any, leading: int = 0) -> Any:
        """The result with nan, False or NOT_VALID where nothing could be asked."""
        if isinstance(result, dict):
            return {name: self.put_back(one, leading) for name, one in result.items()}
        if isinstance(result, tuple):
            return type(result)(*(self.put_back(one, leading) for one in result))
        kind = result.dtype.kind
        filling = np.nan if kind == "f" else False if kind == "b" else Outside.NOT_VALID
        shape = result.shape[:leading] + self.valid.shape + result.shape[leading + 1 :]
        whole = np.full(shape, filling, result.dtype)
        whole[(slice(None),) * leading + (self.valid,)] = result
        return whole if whole.ndim else whole[()]


def _left(question: Mapping[str, Any]) -> _Left | None:
    """None: all is valid, or such that the compiled part refuses it."""
    arrays = {name: array for name, value in question.items() if (array := _numbers(value)) is not None}
    cores = {name: _CORES.get(name, ()) for name in arrays}
    if len(arrays) < len(question) or any(arrays[n].shape[arrays[n].ndim - len(c) :] != c for n, c in cores.items()):
        return None
    valid = {name: _is_valid(name, array) for name, array in arrays.items()}
    try:
        shape = np.broadcast_shapes(*(one.shape for one in valid.values()))
    except ValueError:
        return None
    together = np.logical_and.reduce([np.broadcast_to(one, shape) for one in valid.values()])
    if together.all() and not any(isinstance(value, np.ma.MaskedArray) for value in question.values()):
        return None
    kept = {}
    for name, array in arrays.items():
        one_for_all = valid[name].ndim == 0 and (shape != () or cores[name] != ())
        kept[name] = array if one_for_all else np.broadcast_to(array, shape + cores[name])[together]
    return _Left(kept, together)


# ---- asking ----------------------------------------------------------------------------------------------------------


def _only(function: Callable[..., Any], arguments: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in arguments.items() if name in function.__signature__.parameters}


def _asked(function: Callable[..., Any], arguments: Mapping[str, Any], invalid: str, leading: int = 0) -> Any:
    """Calls it; with invalid="nan" of what is valid alone."""
    question = _question(arguments) if invalid == "nan" else {}
    if "geometry" in arguments:
        question.pop("wavelength_nm", None)  # one for all
    left = _left(question) if question else None
    if left is None:
        return function(**arguments)
    out = arguments.get("out")
    rest = {name: value for name, value in arguments.items() if name != "out"}
    result = left.put_back(function(**_put(rest, left.question)), leading)
    if out is None:
        return result
    out[...] = result
    return out


def _without_warnings(function: Callable[..., Any], arguments: Mapping[str, Any], invalid: str) -> Any:
    """Of the same question again, of which all has been said."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ExtrapolationWarning)
        return _asked(function, arguments, invalid)


def _validity(arguments: Mapping[str, Any], invalid: str, compiled: Any) -> Any:
    """Of the directions that a question has; the normal stands for one that it has not."""
    question = _question(arguments)
    for name in _ANGLES:
        question.setdefault(name, 0.0)
    left = _left(question) if invalid == "nan" else None
    asked = question if left is None else left.question
    asked = {name: value for name, value in asked.items() if name not in _LIGHT}
    found = compiled.Model.outside(arguments.get("self", arguments.get("model")), **asked)
    if left is not None:
        return left.put_back(found)
    light = [np.shape(question[name])[:-1] for name in _LIGHT if name in question]
    return np.broadcast_to(found, np.broadcast_shapes(np.shape(found), *light))[()]


def _answer(function: Callable[..., Any], question: Question, arguments: dict[str, Any], compiled: Any) -> Any:
    invalid = arguments.pop("invalid", "raise")
    if invalid not in ("raise", "nan"):
        raise ValueError(f"invalid: expected 'raise' or 'nan', not {invalid!r}")
    wanted, as_xarray = arguments.pop("uncertainty", False), arguments.pop("as_xarray", False)
    terms = arguments.pop("terms", None) if question.uncertainty else None
    if terms is not None and not wanted:
        raise ValueError("terms: these are of u, give uncertainty=True")
    value = _asked(function, arguments, invalid, question.leading)
    u = validity = None
    if wanted:
        other = _named(compiled, question.uncertainty)
        u = _without_warnings(other, {**_only(other, arguments), "terms": terms}, invalid)
        validity = _validity(arguments, invalid, compiled)
    if as_xarray:
        from . import _xarray

        known = dict(arguments) if question.uncertainty is None else {**arguments, "terms": terms}
        return _xarray.labelled_answer(
            question.labelled, value, u, validity, known, lambda: _validity(arguments, invalid, compiled)
        )
    if not wanted:
        return value
    return Evaluation(value[0] if question.apertures else value, u, validity)


def _named(compiled: Any, name: str) -> Callable[..., Any]:
    return functools.reduce(getattr, name.split("."), compiled)


def _documentation(function: Callable[..., Any], question: Question) -> tuple[str, list[str]]:
    """The documentation with what is added here, and the names of that."""
    more = ["uncertainty", "terms"] if question.uncertainty else []
    more += ["invalid"] * (not question.apertures) + ["as_xarray"] * (question.labelled is not None)
    types = {"uncertainty": "bool = False", "terms": "Optional[Dict[str, float]] = None", "invalid": "str = 'raise'"}
    added = ", ".join(f"{name}: {types.get(name, 'bool = False')}" for name in more)
    head, _, rest = function.__doc__.partition("\n")
    inner, _, result = head.rpartition(") -> ")
    star = "" if "*, " in inner else "*, "
    signature = f"{inner}, {star}{added}) -> {result}"
    return "\n".join([signature, rest.rstrip(), "", *(_MORE[name] for name in more)]), more


def _taking_masks(function: Callable[..., Any], name: str) -> Callable[..., Any]:
    """A function of matrices or readings, which are nan where they are masked if it is asked with invalid="nan"."""
    if "invalid" not in getattr(getattr(function, "__signature__", None), "parameters", ()):
        return function

    @functools.wraps(function)
    def call(*given: Any, **named: Any) -> Any:
        if named.get("invalid") == "nan" or any(isinstance(one, str) and one == "nan" for one in given):
            given = tuple(map(_filled, given))
            named = {key: _filled(one) for key, one in named.items()}
        return function(*given, **named)

    return _calls.dressed(call, name, function.__doc__ or "")


def _filled(value: Any) -> Any:
    return nan_where_masked(value, float) if np.ma.is_masked(joined_masks(value)) else value


def answering(compiled: Any) -> Callable[[Callable[..., Any], str], Callable[..., Any]]:
    """Makes of a function of the compiled part one that is called as Python's: see _calls.install()."""

    def wrap(function: Callable[..., Any], name: str) -> Callable[..., Any]:
        question = QUESTIONS.get(name)
        if question is None:
            return _taking_masks(_calls.wrapped(function, name), name)
        documentation, more = _documentation(function, question)
        plain = _calls.wrapped(function, name, documentation)
        signature = _calls.arguments_of(documentation.splitlines()[0])
        names = [one.name for one in signature if not one.by_name]
        extra = frozenset(more)

        @functools.wraps(function)
        def call(*given: Any, **named: Any) -> Any:
            if extra.isdisjoint(named):
                return plain(*given, **named)
            wrong = next(_calls.faults(signature, given, named), None)
            if wrong is not None:
                raise TypeError(f"{name}: {wrong}")
            return _answer(plain, question, {**dict(zip(names, given)), **named}, compiled)

        return _calls.dressed(call, name, documentation)

    return wrap


# ---- the reflectance factor ------------------------------------------------------------------------------------------

_TAKES = (
    "(self: mmbrdf._mmbrdf.Model, wavelength_nm: Optional[object] = None, theta_i_deg: object, phi_i_deg: object, "
    "theta_r_deg: object, phi_r_deg: object, *, as_printed: bool = False, threads: Optional[int] = None{}) -> object\n\n"
)


def reflectance_factor(*given: Any, **named: Any) -> Any:
    from . import _mmbrdf as compiled

    return compiled.reflectance_factor(compiled.Model.evaluate(*given, **named)[..., 0, 0])


def reflectance_factor_uncertainty(*given: Any, **named: Any) -> Any:
    from . import _mmbrdf as compiled

    return compiled.reflectance_factor(compiled.Model.evaluate_uncertainty(*given, **named)[..., 0, 0])


reflectance_factor.__doc__ = (
    "reflectance_factor"
    + _TAKES.format("")
    + "The reflectance factor of unpolarized light, pi f11: 1 for the perfect diffuser, a number for each question. Arguments as\n"
    "those of evaluate()."
)
reflectance_factor_uncertainty.__doc__ = (
    "reflectance_factor_uncertainty"
    + _TAKES.format(", terms: Optional[Dict[str, float]] = None")
    + "Its standard uncertainty, of the fit and of the terms, as those of evaluate_uncertainty()."
)


def install(compiled: Any) -> None:
    """What is of Python alone."""
    wrap = answering(compiled)
    for function in (reflectance_factor_uncertainty, reflectance_factor):
        _calls.install_function(compiled.Model, function, wrap)
