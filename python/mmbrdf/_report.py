# SPDX-License-Identifier: BSD-3-Clause
"""A report on a model, with samples beside it or not, or on samples before there is a model: what `mmbrdf report` or `mmbrdf
inspect` prints, with pictures, as a page, on paper, as Markdown or for programs."""

from __future__ import annotations

import argparse
import errno
import html
import json
import os
import shlex
import sys
import tempfile
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

import numpy as np

from . import Dataset, Model, __version__, _table_options, material, materials, report_json
from ._arguments import number, require
from ._browser import printed, required_browser
from ._files import digest, digest_of_what_was_read, identity, said
from ._mmbrdf import _report_document, _report_markdown, _shown_name_of, _utc_timestamp, _write_text
from ._pages import PAPERS, document, parts

KINDS = {".md": "markdown", ".html": "html", ".htm": "html", ".pdf": "pdf", ".json": "json"}
NOTATIONS = ("brackets", "plus-minus")


class Source(NamedTuple):
    """What a report is on. digests has the SHA-256 of files, by their names, as they were when they were read."""

    model: Model | None
    data: Dataset | None
    name: str
    data_name: str
    wavelength_nm: float | Sequence[float] | None = None
    theta_i_deg: float = 45.0
    model_file: str | os.PathLike[str] | None = None
    data_file: str | os.PathLike[str] | None = None
    command: str = ""
    digests: Mapping[str, str] = {}
    terms: Mapping[str, float] | Sequence[str] | None = None
    """Of type B, by their names or as they are typed."""
    table_options: Sequence[str] = ()
    """Those with which the data were read, as they are typed."""


class Look(NamedTuple):
    """How it is written; ``paper`` is of a PDF."""

    notation: str = "brackets"
    paper: str = "a4"


def kind_of(path: str | os.PathLike[str], chosen: str | None = None) -> str:
    """By the ending of the file, unless it is chosen. Raises ValueError for others."""
    if chosen is not None:
        if chosen not in KINDS.values():
            raise ValueError(f"format = {chosen!r}, expected markdown, html, pdf or json")
        return chosen
    ending = Path(path).suffix.lower()
    if ending not in KINDS:
        raise ValueError(f"{os.fspath(path)}: expected a file that ends with .md, .html, .pdf or .json")
    return KINDS[ending]


def _digest(source: Source, path: str | os.PathLike[str]) -> str:
    """As it was read, or is now, if others have read it."""
    known = source.digests.get(os.fspath(path))
    return digest(path) if known is None else known


def _file_of_data(source: Source) -> tuple[str, str, str]:
    """The file, or the samples as Dataset.save() writes them."""
    assert source.data is not None
    if source.data_file is not None:
        return "data", Path(source.data_file).name, _digest(source, source.data_file)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "samples.csv"
        source.data.save(path)
        return "samples as CSV", source.data_name, digest(path)


def _origin(source: Source) -> dict[str, Any]:
    files = []
    if source.model_file is None:
        files.append(("model", source.name, ""))
    elif os.fspath(source.model_file) in materials():
        files.append(("model", f"{os.fspath(source.model_file)} (built in)", ""))
    else:
        files.append(("model", Path(source.model_file).name, _digest(source, source.model_file)))
    if source.data is not None:
        files.append(_file_of_data(source))
    return {
        "date": _utc_timestamp(),
        "software": f"mmbrdf {__version__}",
        "command": source.command or "mmbrdf.report() in Python",
        "model": shlex.quote("MODEL" if source.model_file is None else Path(source.model_file).name),
        "data": shlex.join(
            ["DATA.csv" if source.data_file is None else Path(source.data_file).name, *source.table_options]
        ),
        "files": files,
    }


def _wavelengths(model: Model, data: Dataset | None) -> list[float] | None:
    """At which to report if nobody says it: the first that are known. None: the library knows, or refuses."""
    return list(model.wavelengths_nm or (data.wavelengths_nm if data is not None else ()) or model.reflectance) or None


def _chosen(wavelength_nm: float | Sequence[float] | None) -> list[float] | None:
    return None if wavelength_nm is None else [number("wavelength_nm", one) for one in np.atleast_1d(wavelength_nm)]


def titled(model: Model, file: str) -> Model:
    """As its pictures name a model that was read from a file: by its own name, and that of the file where it is another."""
    shown = _shown_name_of(model, file)
    return model if model.name and shown == file else model.renamed(shown)


def _draw(source: Source, block: dict[str, Any]) -> Any:
    """The figure of a block."""
    from . import plot

    assert source.model is not None
    model = titled(source.model, source.name) if source.name else source.model
    things = [model, source.data] if block["of_data"] else [model]
    function = getattr(plot, block["plot"].replace("-", "_"))
    return function(*things, **block["arguments"], width_cm=block["width_cm"])[0]


class Report(NamedTuple):
    """Facts for programs, and the document that people read, both of report.hpp; of samples alone there are neither, and the
    page is that of their inspection."""

    source: Source
    facts: dict[str, Any]
    document: str


def _checked(source: Source, look: Look) -> Source:
    """With samples of the wavelengths that were asked for. Raises TypeError and ValueError."""
    if source.model is not None or source.data is None:
        require("model", source.model, Model)
    elif source.terms:
        raise ValueError("terms: they are of the u of a model, and there is none")
    if source.data is not None:
        require("data", source.data, Dataset)
        if len(source.data) == 0:
            raise ValueError(f"{source.data_name}: no samples")
    for name, value, known in (("notation", look.notation, NOTATIONS), ("paper", look.paper, tuple(PAPERS))):
        if value not in known:
            raise ValueError(f"{name} = {value!r}, expected {' or '.join(known)}")
    chosen = _chosen(source.wavelength_nm)
    if chosen is not None and source.data is not None:
        source = source._replace(data=source.data.at_wavelengths(chosen))
    return source._replace(theta_i_deg=number("theta_i_deg", source.theta_i_deg), wavelength_nm=chosen)


def _made(source: Source, look: Look) -> Report:
    """Of a model."""
    model = source.model
    assert model is not None
    name = source.name or model.name or "the model"
    chosen = source.wavelength_nm or _wavelengths(model, source.data)
    text = report_json(model, name, chosen, source.data, source.data_name, source.terms)
    origin = _origin(source._replace(name=name))
    whole = _report_document(model, text, origin, look.notation, source.theta_i_deg)
    files = [{"what": what, "name": file, "sha256": sha256 or None} for what, file, sha256 in origin["files"]]
    said = {name: origin[name] for name in ("date", "software", "command")}
    return Report(source, {**json.loads(text), "origin": {**said, "files": files}}, whole)


def _page(source: Source, look: Look, paper: str | None) -> str:
    """As HTML."""
    if source.model is None:
        from . import _inspection

        path = source.data_name if source.data_file is None else os.fspath(source.data_file)
        return _inspection.page(
            source.data,
            source.data_name,
            partial(_inspection.fit_command, path, source.wavelength_nm, source.table_options),
            paper,
            _origin_lines(source),
        )
    made = _made(source, look)
    whole = json.loads(made.document)
    shown = parts(whole["blocks"], lambda block: _draw(made.source, block))
    return document(whole["title"], [f"<h1>{html.escape(whole['title'])}</h1>", *shown], paper)


def _origin_lines(source: Source) -> dict[str, str]:
    what, name, sha256 = _file_of_data(source)
    return {
        "date": _utc_timestamp(),
        what: name,
        **({f"SHA-256 of the {what}": sha256} if sha256 else {}),
        "software": f"mmbrdf {__version__}",
        "command": source.command or "mmbrdf.report() in Python",
    }


def made(source: Source, kind: str, look: Look = Look()) -> str | bytes:
    """The report as text, or as the bytes of a PDF. Raises ValueError where it cannot be made."""
    source = _checked(source, look)
    if kind == "html":
        return _page(source, look, None)
    if kind == "pdf":
        required_browser()
        return printed(_page(source, look, look.paper), _utc_timestamp())
    if source.model is None:
        raise ValueError(f"{source.data_name}: a report on samples alone is a page: .html or .pdf")
    report = _made(source, look)
    if kind == "json":
        return json.dumps(report.facts, indent=2, ensure_ascii=False) + "\n"
    return str(_report_markdown(report.document))


def page(
    model: Model | None,
    data: Dataset | None = None,
    *,
    name: str = "",
    data_name: str = "samples",
    wavelength_nm: float | Sequence[float] | None = None,
    theta_i_deg: float = 45,
) -> str:
    """The report as HTML text: see mmbrdf.report()."""
    return str(made(Source(model, data, name, data_name, wavelength_nm, theta_i_deg), "html"))


def require_folder(path: str | os.PathLike[str]) -> None:
    """Raises FileNotFoundError where there is none for a file; asked before pictures are drawn, which takes seconds."""
    if not Path(path).parent.exists():
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), os.fspath(path))


def write(path: str | os.PathLike[str], text: str | bytes) -> None:
    """All of it or nothing: links are followed, modes kept, devices written directly."""
    require_folder(path)
    _write_text(path, text)


def _require_kept(output: str, inputs: Sequence[str | None]) -> None:
    """Raises ValueError if the page would take the place of what it is about, under whatever names and links."""
    for name in inputs:
        if name and os.path.isfile(output) and os.path.exists(name) and os.path.samefile(output, name):
            raise ValueError(f"{output}: would overwrite {name}")


def _numbers(text: str) -> list[float]:
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f'"{text}": expected numbers with commas between') from None


class _Parser(argparse.ArgumentParser):
    """Wrong usage is one line, and where to look, as it is of the program."""

    def error(self, message: str) -> NoReturn:
        print(f"{self.prog.split()[0] if self.prog.startswith('mmbrdf') else self.prog}: {message}", file=sys.stderr)
        print(f"see {self.prog} --help", file=sys.stderr)
        sys.exit(2)


def _parser(prog: str) -> _Parser:
    parser = _Parser(prog=prog, description=__doc__, allow_abbrev=False)
    add = parser.add_argument
    add("model", metavar="MODEL", help="built-in name, JSON model or coefficient CSV; or DATA.csv alone, before a fit")
    add("data", metavar="DATA.csv", nargs="?", help="samples to set beside a model")
    add(
        "-o",
        "--output",
        metavar="REPORT",
        default="-",
        help="where it goes: .md, .html, .pdf or .json; - is standard output",
    )
    add("-w", "--wavelength", metavar="NM[,NM...]", type=_numbers, help="wavelengths to report on")
    add(
        "-i",
        "--incident",
        "--theta-i",
        dest="theta_i",
        metavar="DEG",
        type=float,
        default=45,
        help="angle of incidence of the pictures of a model [45]",
    )
    add("--format", choices=tuple(dict.fromkeys(KINDS.values())), help="whatever the ending of REPORT")
    add("--term", dest="terms", metavar="[NAME:]KIND=U[,dof=N]", action="append", help="of type B, added to all u")
    add("--notation", choices=NOTATIONS, default="brackets", help="0.98412(32), or 0.98412 ± 0.00032 [brackets]")
    add("--paper", choices=tuple(PAPERS), default="a4", help="of a PDF [a4]")
    _table_options.add_to(parser)
    add("--made-by", default="", help=argparse.SUPPRESS)
    return parser


def _opened(name: str, options: argparse.Namespace, digests: dict[str, str]) -> Model | Dataset:
    """A model or samples. Adds the digest of a file."""
    if name in materials():
        return material(name)
    before = identity(name) if os.path.exists(name) else ()
    result = _table_options.opened(name, options)
    digests[name] = digest_of_what_was_read(name, before)
    return result


def _source_of(options: argparse.Namespace, command: str) -> Source:
    digests: dict[str, str] = {}
    table = _table_options.words(options)
    model = _opened(options.model, options, digests)
    if isinstance(model, Dataset) and options.data is None:
        source = Source(None, model, "", Path(options.model).name, options.wavelength, data_file=options.model)
        return source._replace(command=command, digests=digests, terms=options.terms, table_options=table)
    data = _opened(options.data, options, digests) if options.data else None
    for name, thing, kind in ((options.model, model, Model), (options.data, data, Dataset)):
        if thing is not None and not isinstance(thing, kind):
            raise ValueError(f"{name}: expected {'a model' if kind is Model else 'samples'}")
    assert isinstance(model, Model) and not isinstance(data, Model)
    names = Path(options.model).name, Path(options.data or "").name
    source = Source(model, data, *names, options.wavelength, options.theta_i, options.model, options.data)
    return source._replace(command=command, digests=digests, terms=options.terms, table_options=table)


def _command(prog: str, words: Sequence[str], paths: Sequence[str | None]) -> str:
    """As one would type it, with the folders left out of these paths."""
    shown = []
    for word in words:
        path = next((each for each in paths if each and word.endswith(each)), None)
        shown.append(word if path is None else word[: len(word) - len(path)] + Path(path).name)
    return f"{prog} {shlex.join(shown)}"


def main(arguments: Sequence[str] | None = None, prog: str = "python3 -m mmbrdf.report") -> int:
    """python3 -m mmbrdf.report. Exit status: 0, 1 for bad input, 2 for wrong usage."""
    parser = _parser(prog)
    words = list(sys.argv[1:] if arguments is None else arguments)
    options = parser.parse_args(words)
    output, there = options.output, options.output != "-"
    if not there and options.format is None:
        options.format = "markdown"
    try:
        kind = kind_of(output, options.format)
    except ValueError as error:
        parser.error(f"--output {error}, or --format")
    built_in = options.model in materials()
    own = "mmbrdf" if options.made_by else parser.prog
    command = options.made_by or _command(prog, words, [options.model, options.data, output])
    try:
        _require_kept(output, [options.data] if built_in else [options.model, options.data])
        if there:
            require_folder(output)
        report = made(_source_of(options, command), kind, Look(options.notation, options.paper))
        if there:
            write(output, report)
        else:
            sys.stdout.buffer.write(report if isinstance(report, bytes) else report.encode())
            sys.stdout.flush()
    except ImportError as error:
        print(f"{own}: a report with pictures needs matplotlib: {error}", file=sys.stderr)
        return 1
    except (OSError, ValueError) as error:
        print(f"{own}: {said(error)}", file=sys.stderr)
        return 1
    return 0
