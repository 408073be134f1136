# SPDX-License-Identifier: BSD-3-Clause
"""Readings of a polarimeter as users have them: a file, or a table, anything with columns by name."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ._arguments import joined_masks

_STATES = ("generator_state", "analyzer_state")
_READINGS = ("number", *_STATES, "intensity")
_MORE = ("dark", "monitor", "gain")

# What each argument needs; names behind one another are of one column.
_NEEDED: dict[str, tuple[tuple[str, ...], ...]] = {
    "references": (("wavelength_nm",), ("reference",), ("angle_deg",), *((name,) for name in _READINGS)),
    "raw": (
        ("wavelength_nm", "wavelength_um", "lambda"),
        ("theta_i_deg", "theta_i_rad"),
        ("phi_i_deg", "phi_i_rad", "delta_phi_deg", "delta_phi_rad"),
        ("theta_r_deg", "theta_r_rad"),
        ("phi_r_deg", "phi_r_rad", "delta_phi_deg", "delta_phi_rad"),
        *((name,) for name in _READINGS),
    ),
}
_OPTIONAL = {"references": ("s_exceeds_p", "delta_sign", *_MORE), "raw": _MORE}


def source(given: Any, columns: Mapping[str, str], argument: str) -> tuple[Any, str | None]:
    """(path, None), (path, text with the names that are wanted) or (None, text): what the compiled part reads."""
    if isinstance(given, (str, bytes, os.PathLike)):
        return (given, _renamed(given, columns, argument)) if columns else (given, None)
    table = _columns_of(given, argument)
    chosen = dict(_chosen(table, columns, argument))
    return None, _text(_as_rows(chosen, argument))


def _columns_of(given: Any, argument: str) -> dict[str, Any]:
    names = getattr(getattr(given, "dtype", None), "names", None)
    if names is None and hasattr(given, "keys") and hasattr(given, "__getitem__"):
        names = [name for name in given.keys() if isinstance(name, str)]
        names += [name for name in getattr(given, "coords", ()) if name not in names]
    if names is None:
        raise TypeError(
            f"{argument}: expected a path, or a table with keys and arrays such as a dict, not {type(given).__name__}"
        )
    return {name: given[name] for name in names}


def _alternatives(argument: str) -> Iterator[str]:
    for names in _NEEDED[argument]:
        yield from names
    yield from _OPTIONAL[argument]


def _require_columns(present: list[str], columns: Mapping[str, str], argument: str) -> None:
    """Refuses names that nobody has, and says all that are missing at once."""
    known = list(dict.fromkeys(_alternatives(argument)))
    wrong = [name for name in columns if name not in known]
    if wrong:
        raise ValueError(f"columns: nothing is called {', '.join(wrong)} here; there are {', '.join(known)}")
    absent = [theirs for theirs in columns.values() if theirs not in present]
    if absent:
        raise ValueError(f"{argument}: no column {', '.join(absent)}, as columns has it; there are {_list(present)}")
    named = [name for name in present if name not in columns.values()] + list(columns)
    missing = [names[0] for names in _NEEDED[argument] if not set(names) & set(named)]
    if missing:
        raise ValueError(
            f"{argument}: no column {', '.join(missing)}; there are {_list(present)}; columns={{'{missing[0]}': ...}} "
            "has other names"
        )


def _list(names: list[str]) -> str:
    return ", ".join(names[:20]) + (", ..." if len(names) > 20 else "") if names else "none"


def _chosen(table: dict[str, Any], columns: Mapping[str, str], argument: str) -> Iterator[tuple[str, np.ndarray]]:
    _require_columns(list(table), columns, argument)
    for name in dict.fromkeys(_alternatives(argument)):
        theirs = columns.get(name, name)
        if theirs not in table or (name not in columns and theirs in columns.values()):
            continue
        values = np.asarray(table[theirs])
        if values.ndim > 1:
            raise ValueError(f"{argument}: {theirs} has the shape {values.shape}, expected a number for each row")
        if np.ma.is_masked(joined_masks(table[theirs])):
            raise ValueError(f"{argument}: {theirs} is masked in part: leave these rows out")
        yield name, values


def _as_rows(chosen: dict[str, np.ndarray], argument: str) -> dict[str, np.ndarray]:
    try:
        arrays = dict(zip(chosen, np.broadcast_arrays(*(np.atleast_1d(values) for values in chosen.values()))))
    except ValueError:
        lengths = ", ".join(f"{name} {values.size}" for name, values in chosen.items())
        raise ValueError(f"{argument}: columns of different lengths: {lengths}") from None
    if any((arrays[name] == 0).any() for name in _STATES if arrays[name].dtype.kind in "iuf"):
        for name in _STATES:  # counted from 0
            arrays[name] = arrays[name] + 1
    return arrays


def _text(arrays: dict[str, np.ndarray]) -> str:
    out = io.StringIO()
    lines = csv.writer(out, lineterminator="\n")
    lines.writerow(arrays)
    lines.writerows(zip(*(map(_field, values.tolist()) for values in arrays.values())))
    return out.getvalue()


def _field(value: Any) -> str:
    if isinstance(value, bytes):
        return value.decode()
    return str(int(value)) if isinstance(value, float) and value.is_integer() else str(value)


def _renamed(path: Any, columns: Mapping[str, str], argument: str) -> str:
    """The text of a file, with our names in its header."""
    with open(path, encoding="utf-8-sig", newline="") as file:
        above = []
        for line in file:
            if line.strip() and not line.startswith("#"):
                break
            above.append(line)
        else:
            line = ""
        names = [name.strip() for name in line.rstrip("\r\n").split(",")]
        _require_columns(names, columns, argument)
        ours = {theirs: name for name, theirs in columns.items()}
        # A column that stands in for another is not that other any more.
        header = [ours.get(name, f"other_{name}" if name in columns else name) for name in names]
        return "".join(above) + ",".join(header) + "\n" + file.read()
