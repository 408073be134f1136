# SPDX-License-Identifier: BSD-3-Clause
"""How tables of samples are read, as the options of commands say it: the same as the program's."""

from __future__ import annotations

import argparse
import os
from typing import Any

from . import Dataset, Model, load, materials, read_samples
from ._mmbrdf import _holds_samples

FRAMES = ("xy", "sp", "scattering_plane")

FLAGS = {
    "columns": "--columns",
    "skip_incomplete": "--skip-incomplete",
    "table_frame": "--frame",
    "convention": "--convention",
}
"""By their names among the options."""


def _columns(text: str) -> dict[str, str]:
    """NAME=THEIRS,…"""
    pairs = [part.partition("=") for part in text.split(",")]
    if not all(own and equals and theirs for own, equals, theirs in pairs):
        raise argparse.ArgumentTypeError(f'"{text}": expected NAME=THEIRS[,...]')
    return {own: theirs for own, _, theirs in pairs}


def add_to(parser: argparse.ArgumentParser) -> None:
    """What is not given is None."""
    add = parser.add_argument
    add("--columns", metavar="NAME=THEIRS[,...]", type=_columns, help="of DATA.csv that have other names")
    add(
        "--skip-incomplete",
        action="store_true",
        default=None,
        help="pass over rows with NA or NaN, or without an angle or wavelength",
    )
    add(
        "--frame",
        dest="table_frame",
        choices=FRAMES,
        help="of the matrices of DATA.csv [as its column frame says, or xy; sp of f_ss ... f_pp]",
    )
    add("--convention", help="signs of their Stokes vectors [germer2017]")


def given(options: argparse.Namespace) -> list[str]:
    """Those that were given, as they are typed."""
    return [flag for name, flag in FLAGS.items() if getattr(options, name) is not None]


def words(options: argparse.Namespace) -> list[str]:
    """The same with their values."""
    result = []
    for flag, value in ((flag, getattr(options, name)) for name, flag in FLAGS.items()):
        if isinstance(value, dict):
            value = ",".join(f"{own}={theirs}" for own, theirs in value.items())
        result += [] if value is None else [flag] if value is True else [flag, value]
    return result


def opened(name: str, options: argparse.Namespace) -> Model | Dataset:
    """A model, or samples whose table is read as the options say. Raises ValueError where there is no such file."""
    if not os.path.exists(name):
        raise ValueError(f"{name}: no such file, and not a built-in model ({', '.join(materials())})")
    if not _holds_samples(name):
        return load(name)
    how: dict[str, Any] = {
        "columns": options.columns,
        "skip_incomplete": options.skip_incomplete,
        "frame": options.table_frame,
        "convention": options.convention,
    }
    return read_samples(name, **{option: value for option, value in how.items() if value is not None})
