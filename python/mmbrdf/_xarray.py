# SPDX-License-Identifier: BSD-3-Clause
"""Results with named dimensions, units and conventions."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._mmbrdf import Model, __version__, quantities
from ._results import Outside

if TYPE_CHECKING:
    import xarray

_ATTRIBUTES = {
    "wavelength_nm": {"units": "nm", "long_name": "wavelength in vacuum"},
    "theta_i_deg": {"units": "degree", "long_name": "polar angle of the direction to the source"},
    "phi_i_deg": {"units": "degree", "long_name": "azimuth of the direction to the source, from x towards y"},
    "theta_r_deg": {"units": "degree", "long_name": "polar angle of the direction to the detector"},
    "phi_r_deg": {"units": "degree", "long_name": "azimuth of the direction to the detector, from x towards y"},
}
_LONG_NAMES = {
    "brdf": "Mueller matrix BRDF",
    "uncertainty": "standard uncertainty (k = 1) of the Mueller matrix BRDF",
    "reflectance_factor": "reflectance factor of unpolarized light",
    "dhr": "directional-hemispherical reflectance",
    "hdr": "hemispherical-directional reflectance factor",
    "bhr": "bihemispherical reflectance",
}
_AXES = {"xy": "(y, x)", "sp": "(s, p)", "scattering_plane": "(perpendicular, parallel)"}


def _dimension_names(shape: tuple[int, ...], arguments: dict[str, np.ndarray]) -> list[str]:
    """An axis that one argument alone spans has its name; any other is axis_0, axis_1, …"""
    names = []
    for axis, length in enumerate(shape):
        behind = len(shape) - axis  # how many dimensions an argument has whose first this is
        # An axis of length 1 is of those that begin with it: in arguments of more dimensions it may only fill a place.
        spanning = [
            name
            for name, values in arguments.items()
            if values.ndim >= behind and values.shape[-behind] == length and (length != 1 or values.ndim == behind)
        ]
        alone = len(spanning) == 1 and arguments[spanning[0]].size == length
        names.append(spanning[0] if alone else f"axis_{axis}")
    return names


def _coordinates(shape: tuple[int, ...], names: list[str], arguments: dict[str, np.ndarray]) -> dict[str, Any]:
    coordinates: dict[str, Any] = {}
    for name, values in arguments.items():
        if name in names:
            coordinates[name] = ([name], values.reshape(-1), _ATTRIBUTES[name])
        elif values.size == 1:
            coordinates[name] = ([], values.reshape(()), _ATTRIBUTES[name])
        else:
            coordinates[name] = (names, np.broadcast_to(values, shape), _ATTRIBUTES[name])
    return coordinates


_MATRIX_AXES = {
    "row": (["row"], np.arange(1, 5), {"long_name": "outgoing Stokes component"}),
    "column": (["column"], np.arange(1, 5), {"long_name": "incoming Stokes component"}),
}


def _of_frame(frame: str) -> dict[str, str]:
    return {
        "frame": frame,
        "axes": f"{_AXES[frame]} of each beam",
        "convention": "germer2017: S2 = first axis - second axis, S4 = left - right, time factor exp(-i omega t)",
    }


def _about(model: Model, as_printed: bool) -> dict[str, Any]:
    return {
        "directions": "away from the sample; forward scattering is phi_r - phi_i = 180 degrees",
        "as_printed": int(as_printed or model.as_printed),  # netCDF has no truth values
        "model": model.name,
        "software": f"mmbrdf {__version__}",
    }


class _Names:
    """The axes of an answer, and what is known of it."""

    def __init__(self, model: Model, shape: tuple[int, ...], arguments: Mapping[str, Any]) -> None:
        own = {name: arguments.get(name) for name in _ATTRIBUTES}
        if own["wavelength_nm"] is None and len(model.wavelengths_nm) == 1:
            own["wavelength_nm"] = model.wavelengths_nm[0]
        given = {name: _as_float(value) for name, value in own.items() if value is not None}
        self.axes = _dimension_names(shape, given)
        self.coordinates = _coordinates(shape, self.axes, given)
        self.about = _about(model, bool(arguments.get("as_printed")))

    def matrices(self, frame: str) -> tuple[list[str], dict[str, Any], dict[str, str]]:
        """Axes, coordinates and attributes of arrays (..., 4, 4)."""
        return [*self.axes, "row", "column"], {**self.coordinates, **_MATRIX_AXES}, _of_frame(frame)


def _as_float(value: Any) -> np.ndarray:
    return np.ma.filled(np.ma.asarray(value, dtype=float), np.nan) if np.ma.isMA(value) else np.asarray(value, float)


def _terms(terms: Mapping[str, float] | None) -> str:
    return json.dumps({name: float(value) for name, value in (terms or {}).items()})


def labelled(
    values: np.ndarray,
    quantity: str,
    model: Model,
    frame: str,
    arguments: Mapping[str, Any],
    *,
    as_printed: bool = False,
    terms: Mapping[str, float] | None = None,
) -> xarray.DataArray:
    """An array (..., 4, 4) as Model.evaluate() gives it, with the arguments as coordinates."""
    import xarray

    names = _Names(model, values.shape[:-2], {**arguments, "as_printed": as_printed})
    axes, coordinates, _ = names.matrices(frame)
    return xarray.DataArray(
        values, coordinates, axes, quantity, _matrix_attributes(quantity, model, frame, as_printed, terms)
    )


def _matrix_attributes(
    quantity: str, model: Model, frame: str, as_printed: bool, terms: Mapping[str, float] | None
) -> dict[str, Any]:
    attributes = {"units": "sr-1", "long_name": _LONG_NAMES[quantity], **_of_frame(frame), **_about(model, as_printed)}
    return {**attributes, "terms": _terms(terms)} if quantity == "uncertainty" else attributes


def with_attributes(
    values: xarray.DataArray,
    quantity: str,
    model: Model,
    frame: str,
    *,
    as_printed: bool = False,
    terms: Mapping[str, float] | None = None,
) -> xarray.DataArray:
    """What was evaluated of named arguments, with the name, labels and attributes that labelled() gives."""
    result = values.assign_coords(_MATRIX_AXES).rename(quantity)
    result.attrs = {**values.attrs, **_matrix_attributes(quantity, model, frame, as_printed, terms)}
    return result


_FLAGS = [flag for flag in Outside if flag]
_FLAG_ATTRIBUTES = {
    "long_name": "which of the fitted ranges a question leaves; 0: none",
    "flag_masks": np.array([int(flag) for flag in _FLAGS], np.uint8),
    "flag_values": np.array([int(flag) for flag in _FLAGS], np.uint8),
    "flag_meanings": " ".join(
        {
            Outside.UNKNOWN_RANGE: "unknown_range",
            Outside.INTERPOLATED: "interpolated",
            Outside.NOT_VALID: "not_valid",
        }.get(flag, f"outside_{flag.name.lower()}")
        for flag in _FLAGS
    ),
}


def _light(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """Of one Stokes vector."""
    given = {name: arguments[name] for name in ("stokes", "analyzer") if arguments.get(name) is not None}
    return {name: np.asarray(value, float) for name, value in given.items() if np.ndim(value) == 1}


def _dataset(names: _Names, variables: dict[str, Any], coordinates: dict[str, Any], title: str) -> xarray.Dataset:
    import xarray

    about = {"Conventions": "CF-1.10", "title": title, **names.about}
    return xarray.Dataset(variables, coordinates, about)


def labelled_answer(
    quantity: str,
    value: Any,
    u: Any,
    validity: Any,
    arguments: Mapping[str, Any],
    find_validity: Callable[[], Any],
) -> xarray.DataArray | xarray.Dataset:
    """An answer with names: a DataArray of the value alone, or with u and validity a Dataset as the CF conventions have it."""
    import xarray

    model, frame, terms = (
        arguments.get("self", arguments.get("model")),
        arguments.get("frame", "xy"),
        arguments.get("terms"),
    )
    if quantity == "analysis":
        return _analysis(value, find_validity(), model, arguments)
    if quantity in ("brdf", "uncertainty") and u is None:
        printed = bool(arguments.get("as_printed"))
        return labelled(value, quantity, model, frame, arguments, as_printed=printed, terms=terms)
    value = np.asarray(value)
    if quantity == "brdf":
        names = _Names(model, value.shape[:-2], arguments)
        axes, coordinates, attributes = names.matrices(frame)
        attributes["units"] = "sr-1"
    else:
        names = _Names(model, value.shape, arguments)
        axes, coordinates, attributes = names.axes, names.coordinates, {"units": "1", **_light(arguments)}
    attributes["long_name"] = _LONG_NAMES[quantity]
    if u is None:
        return xarray.DataArray(value, coordinates, axes, quantity, {**attributes, **names.about})
    beside = {
        **attributes,
        "long_name": f"standard uncertainty (k = 1) of the {attributes['long_name']}",
        "terms": _terms(terms),
    }
    variables = {
        quantity: (axes, value, {**attributes, "ancillary_variables": "uncertainty validity"}),
        "uncertainty": (axes, np.asarray(u), beside),
        "validity": (names.axes, np.asarray(validity), _FLAG_ATTRIBUTES),
    }
    return _dataset(names, variables, coordinates, f"{_LONG_NAMES[quantity]} of {model.name}")


_UNITS = {"": "1", "sr^-1": "sr-1", "deg": "degree"}


def _analysis(found: Mapping[str, Any], validity: Any, model: Model, arguments: Mapping[str, Any]) -> xarray.Dataset:
    """What Model.analyze() gives: each quantity, its u, the parts of that, its interval if there is one, and the validity."""
    names = _Names(model, np.shape(validity), arguments)
    variables: dict[str, Any] = {}
    parts: list[str] = []
    for about in quantities():
        one = found.get(about.name)
        if one is None:
            continue
        units = {"units": _UNITS.get(about.unit, about.unit)}
        meaning = about.meaning
        variables[about.name] = (
            names.axes,
            np.asarray(one.value),
            {**units, "long_name": meaning, "ancillary_variables": f"u_{about.name} validity"},
        )
        u = {
            **units,
            "long_name": f"standard uncertainty (k = 1) of {meaning}",
            "terms": _terms(arguments.get("terms")),
        }
        variables[f"u_{about.name}"] = (names.axes, np.asarray(one.u), u)
        parts = list(one.parts)
        each = np.array([np.asarray(part) for part in one.parts.values()])
        variables[f"u_{about.name}_parts"] = (
            ["part", *names.axes],
            each,
            {**units, "long_name": f"parts of u of {meaning}"},
        )
        if arguments.get("draws"):
            for end in ("low", "high"):
                words = {**units, "long_name": f"{end} end of the interval that holds 95 % of {meaning}"}
                variables[f"{about.name}_{end}"] = (names.axes, np.asarray(getattr(one, end)), words)
    variables["validity"] = (names.axes, np.asarray(validity), _FLAG_ATTRIBUTES)
    coordinates = {**names.coordinates, "part": (["part"], np.array(parts, dtype=object), {"long_name": "cause of u"})}
    return _dataset(names, variables, coordinates, f"quantities of {model.name}")
