# SPDX-License-Identifier: BSD-3-Clause
"""Functions of arrays in chunks, and of arrays with names: each chunk is a call, with one thread."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from . import _mmbrdf
from ._signatures import Signature

SIZES = {"row": 4, "column": 4, "stokes": 4, "component": 3, "eigenvalue": 4, "part": 4, "coherency": 16}
SIZES |= {"element": 16, "element_2": 16}


FUNCTIONS: dict[str, Callable[..., Any]] = {}
SIGNATURES: dict[str, Signature] = {}


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
        signature = SIGNATURES[self.function]
        before = _mmbrdf._limit_threads(1)
        try:
            result = FUNCTIONS[self.function](**self.fixed, **dict(zip(self.arrays, arrays, strict=True)))
        finally:
            _mmbrdf._limit_threads(before)
        if len(signature.outputs) > 1:
            return tuple(map(np.asarray, result))
        values = np.asarray(result)
        return np.moveaxis(values, 0, -len(signature.outputs[0])) if signature.leading else values


def core_of(argument: str, value: Any, names: Sequence[str]) -> tuple[str, ...]:
    """What the last axes of an argument are called: by these names if it has them, else its last ones."""
    dims = getattr(value, "dims", None)
    if dims is None:
        return tuple(names)
    if len(dims) < len(names):
        raise ValueError(f"{argument}: dimensions {dims}, expected {len(names)} more of matrices: {', '.join(names)}")
    own = tuple(names) if set(names) <= set(dims) else tuple(dims[len(dims) - len(names) :])
    for own_name, expected in zip(own, names):
        if expected in SIZES and value.sizes[own_name] != SIZES[expected]:
            raise ValueError(
                f"{argument}: axis {own_name!r} has {value.sizes[own_name]} places, expected {SIZES[expected]}"
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
    return {name: sizes.get(name, SIZES.get(name, 0)) for name in names}


def _in_equal_chunks(values: list[Any], cores: list[int]) -> list[Any]:
    """Arrays that are cut at the same places, but for their last axes."""
    import dask.array

    arrays = [dask.array.asarray(value) for value in values]
    where: list[Any] = []
    for array, core in zip(arrays, cores):
        outer = array.ndim - core
        where += [array, [j - outer for j in range(outer)] + [f"core {len(where)} {j}" for j in range(core)]]
    return list(dask.array.core.unify_chunks(*where, warn=False)[1])


class _Whole:
    """A function of chunks, of which those that are whole along their last axes come in lists: it can be sent."""

    def __init__(self, work: Callable[..., Any]):
        self.work = work
        self.__name__ = getattr(work, "function", type(work).__name__)  # as Dask shows it

    def __call__(self, *chunks: Any) -> Any:
        alone = []
        for chunk in chunks:
            while isinstance(chunk, list):
                (chunk,) = chunk
            alone.append(chunk)
        return self.work(*alone)


def by_chunk(
    work: Callable[..., Any],
    arrays: Sequence[Any],
    cores: Sequence[Sequence[str]],
    output: Sequence[str],
    sizes: Mapping[str, int],
    dtype: Any,
) -> Any:
    """What dask.array.apply_gufunc does for one output, without its copy of chunks, whose last axes are whole here."""
    import dask.array

    outer = max(array.ndim - len(core) for array, core in zip(arrays, cores))
    known = {name for core in cores for name in core}
    axes = {name: outer + k for k, name in enumerate(sorted(known.union(output)))}
    given: list[Any] = []
    for array, core in zip(arrays, cores):
        given += [array, [*range(outer - array.ndim + len(core), outer), *(axes[name] for name in core)]]
    return dask.array.blockwise(
        _Whole(work),
        [*range(outer), *(axes[name] for name in output)],
        *given,
        new_axes={axes[name]: sizes[name] for name in output if name not in known},
        dtype=dtype,
        meta=np.empty((0,) * (outer + len(output)), dtype),
    )


def of_dask(call: Call, arrays: Mapping[str, Any], signature: Signature, sizes: Mapping[str, int]) -> Any:
    import dask.array

    inputs = [f"({','.join(signature.arrays[name])})" for name in arrays]
    outputs = [f"({','.join(names)})" for names in signature.outputs]
    known = {name for argument in arrays for name in signature.arrays[argument]}
    new = [name for names in signature.outputs for name in names if name not in known]
    for name, value in arrays.items():
        require_whole(name, value, signature.arrays[name])
    cores = [signature.arrays[name] for name in arrays]
    equal = _in_equal_chunks(list(arrays.values()), list(map(len, cores)))
    if len(outputs) == 1:
        return by_chunk(call, equal, cores, signature.outputs[0], _sizes(new, sizes), signature.dtype)
    return dask.array.apply_gufunc(
        call,
        f"{','.join(inputs)}->{','.join(outputs)}",
        *equal,
        output_dtypes=list(signature.dtypes),
        output_sizes=_sizes(new, sizes),
    )


def of_named(call: Call, arrays: Mapping[str, Any], signature: Signature, sizes: Mapping[str, int]) -> Any:
    import xarray

    cores = []
    renamed: dict[str, str] = {}
    for name, value in arrays.items():
        core = core_of(name, value, signature.arrays[name])
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
