# SPDX-License-Identifier: BSD-3-Clause
"""Functions of many geometries or matrices, of Dask arrays and xarray.DataArrays: in chunks, when asked for, with names.

``install()`` puts one wrapper around each. Of other arguments it calls the function as it is. Of a Dask array the result
is one, whose chunks are worked on by one thread each; of a DataArray it is one, lazy if its data are, with the names
and attributes of what was given. Both have the bits of the call with numpy arrays.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from . import _mmbrdf
from ._signatures import DIRECTIONS, MATRIX, Signature, signatures
from ._stand_ins import shortened, stand_in, tried

_SIZES = {"row": 4, "column": 4, "stokes": 4, "component": 3, "eigenvalue": 4, "part": 4, "coherency": 16}
_SIZES |= {"element": 16, "element_2": 16}


_FUNCTIONS: dict[str, Callable[..., Any]] = {}
_SIGNATURES: dict[str, Signature] = {}


def is_lazy(value: Any) -> bool:
    dask, xarray = sys.modules.get("dask.array"), sys.modules.get("xarray")
    return (dask is not None and isinstance(value, dask.Array)) or (
        xarray is not None and isinstance(value, xarray.DataArray)
    )


class Call:
    """A call of a function by its name, with all arguments but arrays: it can be sent to another process."""

    def __init__(self, function: str, fixed: Mapping[str, Any], arrays: Sequence[str]):
        self.function, self.fixed, self.arrays = function, dict(fixed), tuple(arrays)

    def __call__(self, *arrays: Any) -> Any:
        signature = _SIGNATURES[self.function]
        before = _mmbrdf._limit_threads(1)
        try:
            result = _FUNCTIONS[self.function](**self.fixed, **dict(zip(self.arrays, arrays, strict=True)))
        finally:
            _mmbrdf._limit_threads(before)
        if len(signature.outputs) > 1:
            return tuple(map(np.asarray, result))
        values = np.asarray(result)
        return np.moveaxis(values, 0, -len(signature.outputs[0])) if signature.leading else values


def _bound(signature: Signature, args: Sequence[Any], kwargs: Mapping[str, Any]) -> dict[str, Any] | None:
    """All arguments by their names, and the directions of a geometry by theirs. None: they are too many, or not such."""
    given = dict(zip(signature.parameters, args))
    if len(args) > len(signature.parameters) or given.keys() & kwargs.keys():
        return None
    given.update(kwargs)
    if "geometry" in signature.parameters:
        geometry = given.pop("geometry", ())
        if len(geometry) != len(DIRECTIONS):
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


def _core(argument: str, value: Any, names: Sequence[str]) -> tuple[str, ...]:
    """What the last axes of an argument are called: by these names if it has them, else its last ones."""
    dims = getattr(value, "dims", None)
    if dims is None:
        return tuple(names)
    if len(dims) < len(names):
        raise ValueError(f"{argument}: dimensions {dims}, expected {len(names)} more of matrices: {', '.join(names)}")
    own = tuple(names) if set(names) <= set(dims) else tuple(dims[len(dims) - len(names) :])
    for own_name, expected in zip(own, names):
        if expected in _SIZES and value.sizes[own_name] != _SIZES[expected]:
            raise ValueError(
                f"{argument}: axis {own_name!r} has {value.sizes[own_name]} places, expected {_SIZES[expected]}"
            )
    return own


def require_whole(argument: str, value: Any, core: Sequence[str]) -> None:
    """Refuses chunks that cut one of the last axes, with the call that joins them."""
    chunks = getattr(value, "chunks", None)
    if not chunks or not core:
        return
    dims = getattr(value, "dims", None)
    for k, name in enumerate(core):
        axis = dims.index(name) if dims else len(chunks) - len(core) + k
        if len(chunks[axis]) > 1:
            joined = (
                f".chunk({{{', '.join(f'{one!r}: -1' for one in core)}}})"
                if dims
                else f".rechunk({{{', '.join(f'{j - len(core)}: -1' for j in range(len(core)))}}})"
            )
            raise ValueError(f"{argument}: chunks {chunks[axis]} cut the axis {name!r}: join them, {argument}{joined}")


def _sizes(names: Iterable[str], sizes: Mapping[str, int]) -> dict[str, int]:
    return {name: sizes.get(name, _SIZES.get(name, 0)) for name in names}


def _in_equal_chunks(values: list[Any], cores: list[int]) -> list[Any]:
    """Arrays that are cut at the same places, but for their last axes."""
    import dask.array

    arrays = [dask.array.asarray(value) for value in values]
    where: list[Any] = []
    for array, core in zip(arrays, cores):
        outer = array.ndim - core
        where += [array, [j - outer for j in range(outer)] + [f"core {len(where)} {j}" for j in range(core)]]
    return list(dask.array.core.unify_chunks(*where, warn=False)[1])


def _of_dask(call: Call, arrays: Mapping[str, Any], signature: Signature, sizes: Mapping[str, int]) -> Any:
    import dask.array

    inputs = [f"({','.join(signature.arrays[name])})" for name in arrays]
    outputs = [f"({','.join(names)})" for names in signature.outputs]
    known = {name for argument in arrays for name in signature.arrays[argument]}
    new = [name for names in signature.outputs for name in names if name not in known]
    for name, value in arrays.items():
        require_whole(name, value, signature.arrays[name])
    several = len(outputs) > 1
    return dask.array.apply_gufunc(
        call,
        f"{','.join(inputs)}->{','.join(outputs)}",
        *_in_equal_chunks(list(arrays.values()), [len(signature.arrays[name]) for name in arrays]),
        output_dtypes=list(signature.dtypes) if several else signature.dtype,
        output_sizes=_sizes(new, sizes),
    )


def _of_named(call: Call, arrays: Mapping[str, Any], signature: Signature, sizes: Mapping[str, int]) -> Any:
    import xarray

    cores = []
    renamed: dict[str, str] = {}
    for name, value in arrays.items():
        core = _core(name, value, signature.arrays[name])
        if not hasattr(value, "dims") and np.ndim(value) > len(core):
            raise TypeError(f"{name}: an array without names beside an xarray.DataArray: make it one")
        require_whole(name, value, core)
        renamed.update(zip(signature.arrays[name], core))
        cores.append(core)
    outputs = [tuple(renamed.get(name, name) for name in names) for names in signature.outputs]
    used = {name for core in cores for name in core}
    sized = {renamed.get(n, n): size for n, size in _sizes((n for o in signature.outputs for n in o), sizes).items()}
    values = list(arrays.values())
    named = [i for i, value in enumerate(values) if hasattr(value, "dims")]
    for i, value in zip(named, xarray.unify_chunks(*[values[i] for i in named])):
        values[i] = value
    return xarray.apply_ufunc(
        call,
        *values,
        input_core_dims=cores,
        output_core_dims=outputs,
        dask="parallelized",
        output_dtypes=list(signature.dtypes),
        dask_gufunc_kwargs={"output_sizes": {n: s for n, s in sized.items() if n not in used}},
        keep_attrs=True,
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
    own_names = _core(argument, value, core)
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
    asked = {}
    for name, value in given.items():
        core = signature.arrays.get(name, ())
        sizes = {**_SIZES, **known}
        asked[name] = stand_in(name, value, core, sizes, given) if is_lazy(value) else value
        if name in signature.arrays and not is_lazy(value):
            asked[name] = shortened(value, core)
    return tried(_FUNCTIONS[function], asked)


def lazily(function: str, given: dict[str, Any], sizes: Mapping[str, int] | None = None) -> Any:
    """The function of arguments of which some are Dask arrays or DataArrays."""
    signature = _SIGNATURES[function]
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
    result = (_of_named if named else _of_dask)(call, arrays, signature, sizes)
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
    answer = _FUNCTIONS["Model.analyze"](**arguments)
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
    _SIGNATURES.update(signatures())
    _FUNCTIONS["Model._analyzed"] = _analyzed
    for function, signature in _SIGNATURES.items():
        owner, _, name = function.rpartition(".")
        if name.startswith("_"):
            continue
        if owner:
            kind = package[owner]
            original = vars(kind)[name]
            _FUNCTIONS[function] = functools.partial(_method_call, original)
            setattr(kind, name, _wrapper(function, signature, original))
        else:
            original = package[name]
            _FUNCTIONS[function] = _of_geometry(original) if "geometry" in signature.parameters else original
            package[name] = _wrapper(function, signature, original)
            if getattr(_mmbrdf, name, None) is original:
                setattr(_mmbrdf, name, package[name])  # where pickles look for it


def _of_geometry(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function of four arrays of directions of any shape, which its results have, too."""

    @functools.wraps(function)
    def call(**arguments: Any) -> Any:
        directions = np.broadcast_arrays(*(arguments.pop(name) for name in DIRECTIONS), subok=True)
        found = function(geometry=[one.ravel() for one in directions], **arguments)
        return _reshaped(found, directions[0].shape)

    return call


def _reshaped(found: Any, shape: tuple[int, ...]) -> Any:
    return (
        type(found)(*(_reshaped(one, shape) for one in found)) if isinstance(found, tuple) else np.reshape(found, shape)
    )


def _method_call(method: Callable[..., Any], *, self: Any, **arguments: Any) -> Any:
    return method(self, **arguments)
