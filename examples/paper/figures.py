#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every figure and table of Germer, Appl. Opt. 56, 9333 (2017), from its published data.

    python3 figures.py DATA_FOLDER OUT_FOLDER

DATA_FOLDER holds PTFE.data.csv and PTFE.data.random.csv (figshare 10.6084/m9.figshare.5417410); without
the first the figures are of simulated data, and say so. OUT_FOLDER gets fig1 ... fig7 as PNG and PDF, made with the published basis,
isotropic/ with the same and two more figures of the isotropic basis, tables as CSV, and report.md, which puts the
paper's numbers beside these.
"""
from __future__ import annotations

import argparse
import sys
from pathlib import Path

import drawing
import report
import study as studies

import mmbrdf
import mmbrdf.plot


def write_readme_picture(path: Path) -> None:
    """All elements of the built-in model at 532 nm and 60 degrees, small enough to be kept with the sources."""
    figure, _ = mmbrdf.plot.hemisphere(mmbrdf.material("ptfe"), 532, 60, samples=301, scale="paper")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=88)


def write_figure(figure, path: Path, simulated: bool) -> None:
    """As PNG and PDF."""
    if simulated:
        figure.text(0.995, 0.004, "simulated data", color="#b00000", fontsize=9, ha="right", va="bottom")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path.with_suffix(".png"), dpi=150)
    figure.savefig(path.with_suffix(".pdf"), dpi=150, metadata={"CreationDate": None})


def reproduce(data_folder: Path, out_folder: Path, only: list[str]) -> None:
    for folder in (data_folder, out_folder):
        if folder.exists() and not folder.is_dir():
            raise NotADirectoryError(f"{folder}: not a folder")
    study = studies.load(data_folder)
    if study.simulated:
        print(f"no PTFE.data.csv in {data_folder}: simulating the measurements")
    for basis, folder in ((studies.PUBLISHED, out_folder), (studies.ISOTROPIC, out_folder / "isotropic")):
        for name, draw in drawing.figures(basis):
            if not only or name in only:
                write_figure(draw(study), folder / name, study.simulated)
                print(folder / f"{name}.png")
    if not only or "report" in only:
        report.write(study, out_folder)
        print(out_folder / "report.md")


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data_folder", type=Path, nargs="?", help="where the published data are")
    parser.add_argument("out_folder", type=Path, nargs="?", help="where figures and tables go")
    names = [name for name, _ in drawing.figures(studies.ISOTROPIC)] + ["report"]
    parser.add_argument("--only", metavar="NAME", nargs="+", default=[], choices=names, help=", ".join(names))
    parser.add_argument("--readme", metavar="FILE", type=Path, help="write one small picture of the built-in model")
    options = parser.parse_args(arguments)
    if options.readme is None and options.out_folder is None:
        parser.error("DATA_FOLDER and OUT_FOLDER, or --readme FILE")
    try:
        if options.readme is not None:
            write_readme_picture(options.readme)
        if options.out_folder is not None:
            reproduce(options.data_folder, options.out_folder, options.only)
    except (OSError, ValueError) as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
