# SPDX-License-Identifier: BSD-3-Clause
"""Functions of many geometries or matrices, of Dask arrays and xarray.DataArrays: in chunks, when asked for, with names.

``install()`` puts one wrapper around each. Of other arguments it calls the function as it is. Of a Dask array the result
is one, whose chunks are worked on by one thread each; of a DataArray it is one, lazy if its data are, with the names
and attributes of what was given. Both have the bits of the call with numpy arrays.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from . import _mmbrdf
from ._chunks import FUNCTIONS, SIGNATURES, SIZES, Call, core_of, is_lazy, of_dask, of_named
from ._signatures import DIRECTIONS, MATRIX, Signature, signatures
from ._stand_ins import fewest_draws, shape_alone, shapes_fit, shortened, stand_in, tried


def _bound(signature: Signature, args: Sequence[Any], kwargs: Mapping[str, Any]) -> dict[str, Any] | None:
    """All arguments by their names, and the directions of a geometry by theirs. None: they are too many, or not such."""
    given = dict(zip(signature.parameters, args))
    if len(args) > len(signature.parameters) or given.keys() & kwargs.keys():
        return None
    given.update(kwargs)
    if "geometry" in signature.parameters:
        geometry = given.pop("geometry", ())
        if not hasattr(geometry, "__len__") or len(geometry) != len(DIRECTIONS):
            return None
        given.update(zip(DIRECTIONS, geometry))
        if np.ndim(given.get("wavelength_nm")) == 0 and is_lazy(given.get("wavelength_nm")):
            given["wavelength_nm"] = float(given["wavelength_nm"])
    return given


def _has_lazy(value: Any) -> bool:
    """It is one, or a geometry with one."""
    return is_lazy(value) or (
        isinstance(value, (tuple, list)) and len(value) == len(DIRECTIONS) and any(map(is_lazy, value))
    )


def _named_result(function: str, result: Any, signature: Signature, given: Mapping[str, Any]) -> Any:
    """Its name and attributes: what the arguments had, and what the function says of its own."""
    from . import _xarray

    result = result.copy(deep=False)
    if function in ("Model.evaluate", "Model.evaluate_uncertainty"):
        return _xarray.with_attributes(
            result,
            "brdf" if function == "Model.evaluate" else "uncertainty",
            given["self"],
            given.get("frame", "xy"),
            as_printed=given.get("as_printed", False),
            terms=given.get("terms"),
        )
    result.name = function.rsplit(".", 1)[-1]
    if signature.units is not None:
        result.attrs.pop("units", None)
        if signature.units:
            result.attrs["units"] = signature.units
    if signature.meaning:
        result.attrs["long_name"] = signature.meaning
    if function == "change_frame":
        result.attrs["frame"] = given["to_frame"]
    if function == "reflectance_factor":  # no more of a matrix
        for name in ("frame", "axes", "convention"):
            result.attrs.pop(name, None)
        result = result.drop_vars([name for name in MATRIX if name in result.coords])
    return result


def _shaped(function: str, signature: Signature, given: dict[str, Any]) -> tuple[Signature, dict[str, int]]:
    """Of a polarimeter the instrument says how many readings there are, and draws how many."""
    if function == "Model.evaluate_draws":
        return signature, {"draw": int(given["count"])}
    if not function.startswith("Polarimeter."):
        return signature, {}
    own: _mmbrdf.Polarimeter = given["self"]
    pairs = own.pairs
    core = ("analyzer", "generator") if pairs is None else ("frame",)
    counts = (len(own.analyzer), len(own.generator)) if pairs is None else (len(pairs),)
    if function == "Polarimeter.readings":
        return signature._replace(outputs=(core,)), dict(zip(core, counts))
    argument = next(iter(signature.arrays))
    value = given.get(argument)
    if value is None:
        return signature, {}
    own_names = core_of(argument, value, core)
    lengths = [value.sizes[n] for n in own_names] if hasattr(value, "dims") else np.shape(value)[-len(core) :]
    if tuple(lengths) != counts:
        raise ValueError(f"{argument}: last axes {tuple(lengths)}, the instrument has {counts} ({', '.join(core)})")
    single = function == "Polarimeter.reduce" and getattr(value, "dtype", None) == np.float32
    dtype = np.float32 if single else float
    return signature._replace(arrays={argument: core}, dtype=dtype), dict(zip(core, counts))


def _require_supported(function: str, signature: Signature, given: dict[str, Any]) -> None:
    """Refuses what lazy arrays are not for, and takes away what was said of it."""
    for name in ("out", "as_xarray", "by_term", "uncertainty"):
        if given.get(name) is not None and given[name] is not False:
            raise TypeError(f"{function.rsplit('.', 1)[-1]}: {name} is not for Dask arrays and xarray.DataArrays")
        given.pop(name, None)
    if function == "reflectance_factor" and {"row", "column"} <= set(getattr(given["f11"], "dims", ())):
        raise ValueError("f11: sixteen elements, expected one: give f.sel(row=1, column=1)")
    _require_placed(signature, given)


def _require_placed(signature: Signature, given: Mapping[str, Any]) -> None:
    misplaced = [name for name, value in given.items() if is_lazy(value) and name not in signature.arrays]
    if misplaced:
        raise TypeError(f"{misplaced[0]}: not a Dask array or an xarray.DataArray")


def _tried(function: str, signature: Signature, given: Mapping[str, Any]) -> Any:
    """What the eager call gives of numbers in the place of lazy arrays; raises what that raises."""
    _require_placed(signature, given)
    known: Mapping[str, int] = {}
    if function.startswith("Polarimeter."):
        signature, known = _shaped(function, signature, given)
    sizes = {**SIZES, **known}
    if not shapes_fit({name: given.get(name) for name in signature.arrays}, signature.arrays, sizes):
        tried(FUNCTIONS[function], {name: shape_alone(v) if is_lazy(v) else v for name, v in given.items()})
    asked = {}
    for name, value in given.items():
        core = signature.arrays.get(name, ())
        value = fewest_draws(value) if name in ("count", "draws") else value
        asked[name] = stand_in(name, value, core, sizes, given) if is_lazy(value) else value
        if name in signature.arrays and not is_lazy(value):
            asked[name] = shortened(value, core)
    return tried(FUNCTIONS[function], asked)


def lazily(function: str, given: dict[str, Any], sizes: Mapping[str, int] | None = None) -> Any:
    """The function of arguments of which some are Dask arrays or DataArrays."""
    signature = SIGNATURES[function]
    if given.get("uncertainty") and function in _TOGETHER:
        return _together(function, given)
    _require_supported(function, signature, given)
    signature, known = _shaped(function, signature, given)
    sizes = {**known, **(sizes or {})}
    arrays = {
        name: given[name]
        for name in signature.arrays
        if given.get(name) is not None and (is_lazy(given[name]) or np.ndim(given[name]) > 0)
    }
    call = Call(function, {name: value for name, value in given.items() if name not in arrays}, list(arrays))
    named = any(hasattr(value, "dims") for value in arrays.values())
    result = (of_named if named else of_dask)(call, arrays, signature, sizes)
    if signature.leading:
        result = _first_axis_first(result, signature, named)
    parts = result if len(signature.outputs) > 1 else (result,)
    if named:
        parts = tuple(_named_result(function, part, signature, given) for part in parts)
    if len(parts) == 1:
        return parts[0]
    record = getattr(sys.modules[__package__], signature.record or "")
    if named:
        for name, part in zip(record._fields, parts):
            part.name = name
    return record(*parts)


def _first_axis_first(result: Any, signature: Signature, named: bool) -> Any:
    core = signature.outputs[0]
    if named:
        return result.transpose(core[0], ...)
    import dask.array

    return dask.array.moveaxis(result, -len(core), 0)


_TOGETHER = {
    "Model.evaluate": "Model.evaluate_uncertainty",
    "Model.reflectance_factor": "Model.reflectance_factor_uncertainty",
    "polarized_curve": "polarized_uncertainty",
}
"""u of them."""


def _together(function: str, given: dict[str, Any]) -> Any:
    """Value, u and validity, each as lazy as the arguments."""
    from . import Evaluation

    asked = {name: value for name, value in given.items() if name not in ("uncertainty", "terms")}
    where = {name: asked[name] for name in ("wavelength_nm", *DIRECTIONS, "invalid") if name in asked}
    where["self"] = asked.get("self", asked.get("model"))
    u = lazily(_TOGETHER[function], {**asked, "terms": given.get("terms")})
    return Evaluation(lazily(function, asked), u, lazily("Model.outside", where))


def _fields(answer: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Where each number of an analysis stands: the quantity, and the field or the part of u."""
    places = []
    for name, one in answer.items():
        for field in ("value", "u", "low", "high"):
            if getattr(one, field) is not None:
                places.append((name, field))
        places += [(name, f"part {part}") for part in one.parts]
    return places


def _number(answer: Mapping[str, Any], place: tuple[str, str]) -> Any:
    one = answer[place[0]]
    return one.parts[place[1][5:]] if place[1].startswith("part ") else getattr(one, place[1])


def _analyzed(**arguments: Any) -> Any:
    answer = FUNCTIONS["Model.analyze"](**arguments)
    return np.stack([np.asarray(_number(answer, place)) for place in _fields(answer)], axis=-1)


def _analyze(given: dict[str, Any], like: Mapping[str, Any]) -> Any:
    """All numbers as one array with another axis, of which each is a part; those of one geometry are like them."""
    from . import Analyzed

    if given.pop("as_xarray", False):
        raise TypeError("analyze: as_xarray is not for Dask arrays and xarray.DataArrays")
    places = _fields(like)
    stacked = lazily("Model._analyzed", given, {"number": len(places)})
    at = {place: stacked[..., i] for i, place in enumerate(places)}
    if hasattr(stacked, "dims"):
        known = {q.name: q for q in _mmbrdf.quantities()}
        for (name, field), part in at.items():
            part.name = name if field == "value" else f"{field} of {name}"
            if name in known and known[name].unit:
                part.attrs["units"] = known[name].unit
    return {
        name: Analyzed(
            at[name, "value"],
            at[name, "u"],
            {part: at[name, f"part {part}"] for part in analyzed.parts},
            at.get((name, "low")),
            at.get((name, "high")),
        )
        for name, analyzed in like.items()
    }


def _wrapper(function: str, signature: Signature, original: Callable[..., Any]) -> Callable[..., Any]:
    has_lazy = _has_lazy if "geometry" in signature.parameters else is_lazy

    @functools.wraps(original)
    def wrapped(*args: Any, **kwargs: Any) -> Any:
        if ("dask.array" in sys.modules or "xarray" in sys.modules) and (
            any(map(has_lazy, args)) or any(map(has_lazy, kwargs.values()))
        ):
            given = _bound(signature, args, kwargs)
            if given is None:
                return original(*args, **kwargs)  # which says what is wrong
            like = _tried(function, signature, given)
            return _analyze(given, like) if function == "Model.analyze" else lazily(function, given)
        return original(*args, **kwargs)

    return wrapped


def install(package: dict[str, Any]) -> None:
    """Wraps the functions of the package, and the methods of its classes."""
    SIGNATURES.update(signatures())
    FUNCTIONS["Model._analyzed"] = _analyzed
    for function, signature in SIGNATURES.items():
        owner, _, name = function.rpartition(".")
        if name.startswith("_"):
            continue
        if owner:
            kind = package[owner]
            original = vars(kind)[name]
            FUNCTIONS[function] = functools.partial(_method_call, original)
            setattr(kind, name, _wrapper(function, signature, original))
        else:
            original = package[name]
            FUNCTIONS[function] = _of_geometry(original) if "geometry" in signature.parameters else original
            package[name] = _wrapper(function, signature, original)
            if getattr(_mmbrdf, name, None) is original:
                setattr(_mmbrdf, name, package[name])  # where pickles look for it


def _of_geometry(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function of four arrays of directions of any shape, which its results have, too."""

    @functools.wraps(function)
    def call(**arguments: Any) -> Any:
        given = [arguments.pop(name) for name in DIRECTIONS]
        try:
            directions = np.broadcast_arrays(*given, subok=True)
        except ValueError:
            return function(geometry=given, **arguments)  # which says what is wrong
        found = function(geometry=[one.ravel() for one in directions], **arguments)
        return _reshaped(found, directions[0].shape)

    return call


def _reshaped(found: Any, shape: tuple[int, ...]) -> Any:
    return (
        type(found)(*(_reshaped(one, shape) for one in found)) if isinstance(found, tuple) else np.reshape(found, shape)
    )


def _method_call(method: Callable[..., Any], *, self: Any, **arguments: Any) -> Any:
    return method(self, **arguments)
