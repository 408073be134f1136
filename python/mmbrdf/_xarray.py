# SPDX-License-Identifier: BSD-3-Clause
"""Results with named dimensions, units and conventions."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._mmbrdf import Model, __version__

if TYPE_CHECKING:
    import xarray

_ATTRIBUTES = {
    "wavelength_nm": {"units": "nm", "long_name": "wavelength in vacuum"},
    "theta_i_deg": {"units": "degree", "long_name": "polar angle of the direction to the source"},
    "phi_i_deg": {"units": "degree", "long_name": "azimuth of the direction to the source, from x towards y"},
    "theta_r_deg": {"units": "degree", "long_name": "polar angle of the direction to the detector"},
    "phi_r_deg": {"units": "degree", "long_name": "azimuth of the direction to the detector, from x towards y"},
}
_LONG_NAMES = {"brdf": "Mueller matrix BRDF", "uncertainty": "standard uncertainty (k = 1) of the Mueller matrix BRDF"}
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


def labelled(
    values: np.ndarray,
    quantity: str,
    model: Model,
    frame: str,
    arguments: Mapping[str, np.ndarray | None],
    *,
    as_printed: bool = False,
    terms: Mapping[str, float] | None = None,
) -> xarray.DataArray:
    """An array (..., 4, 4) as Model.evaluate() gives it, with the arguments as coordinates."""
    import xarray

    if arguments.get("wavelength_nm") is None and len(model.wavelengths_nm) == 1:
        arguments = {**arguments, "wavelength_nm": np.asarray(model.wavelengths_nm[0])}
    given = {name: np.asarray(value, dtype=float) for name, value in arguments.items() if value is not None}
    shape = values.shape[:-2]
    names = _dimension_names(shape, given)
    coordinates = _coordinates(shape, names, given)
    labels = {name: ([name], *label) for name, label in _MATRIX_AXES.items()}
    attributes = _attributes(quantity, model, frame, as_printed, terms)
    return xarray.DataArray(values, coordinates | labels, [*names, "row", "column"], quantity, attributes)


_MATRIX_AXES = {
    "row": (np.arange(1, 5), {"long_name": "outgoing Stokes component"}),
    "column": (np.arange(1, 5), {"long_name": "incoming Stokes component"}),
}


def _attributes(
    quantity: str, model: Model, frame: str, as_printed: bool, terms: Mapping[str, float] | None
) -> dict[str, Any]:
    attributes = {
        "units": "sr-1",
        "long_name": _LONG_NAMES[quantity],
        "frame": frame,
        "axes": f"{_AXES[frame]} of each beam",
        "convention": "germer2017: S2 = first axis - second axis, S4 = left - right, time factor exp(-i omega t)",
        "directions": "away from the sample; forward scattering is phi_r - phi_i = 180 degrees",
        "as_printed": int(as_printed or model.as_printed),  # netCDF has no truth values
        "model": model.name,
        "software": f"mmbrdf {__version__}",
    }
    if quantity == "uncertainty":
        attributes["terms"] = json.dumps({name: float(value) for name, value in (terms or {}).items()})
    return attributes


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
    labels = {name: ([name], *label) for name, label in _MATRIX_AXES.items()}
    result = values.assign_coords(labels).rename(quantity)
    result.attrs = {**values.attrs, **_attributes(quantity, model, frame, as_printed, terms)}
    return result
