# SPDX-License-Identifier: BSD-3-Clause
"""What `mmbrdf inspect` says of samples as one HTML page, with pictures."""

from __future__ import annotations

import html
import shlex
from collections.abc import Callable, Iterator, Sequence
from functools import partial

import numpy as np

from . import Dataset, Inspection, __version__, inspect, plot
from ._judgements import Finding
from ._pages import document, picture


def _text(value: object) -> str:
    return html.escape(str(value))


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    top = "".join(f"<th>{_text(name)}</th>" for name in head)
    body = "\n".join("<tr>" + "".join(f"<td>{_text(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return (
        f'<div class="scroll"><table class="words"><thead><tr>{top}</tr></thead>\n<tbody>{body}</tbody></table></div>'
    )


def _contents(data: Dataset, seen: Inspection) -> str:
    """The rows of the program; one without a name goes on with the row above."""
    rows = [("wavelengths", ", ".join(f"{nm:.10g}" for nm in data.wavelengths_nm) + " nm"), *seen.rows.items()]
    if data.read_as:
        rows.append(("read as", data.read_as))
    if data.reduction:
        rows.append(("reduction", data.reduction))
    body = "\n".join(f"<tr><th>{_text(name)}</th><td>{_text(text)}</td></tr>" for name, text in rows)
    return f'<div class="scroll"><table><tbody>{body}</tbody></table></div>'


def _faults(seen: Inspection) -> Iterator[str]:
    if seen.findings:
        yield _table(("fault", "evidence", "what mends it"), [one[:3] for one in seen.findings])
    else:
        yield f"<p>{_text(seen.verdict)}</p>"
    if seen.untested:
        yield "<h2>What cannot be told</h2>"
        yield _table(("fault", "why"), seen.untested)


def _pictures(data: Dataset, seen: Inspection) -> Iterator[str]:
    """At the wavelength of the first sample, which is the one that is fitted."""
    wavelength_nm = float(data.wavelength_nm[0])
    at = f"{wavelength_nm:.10g} nm"
    figure, _ = plot.directions(data, wavelength_nm, inspection=seen)
    yield "<h2>Directions</h2>"
    yield picture(
        figure,
        f"Where was measured, {at}: directions of the source, and of the detector with the source on the left, in projected "
        "direction cosines. Hatched: what no samples support.",
    )
    yield '<h2>Samples</h2>\n<div class="pair">'
    figure, _ = plot.suspicious(data, wavelength_nm, inspection=seen)
    yield picture(figure, f"f11 of the samples, {at}; marked are those that a fault names.")
    if np.isfinite(seen.residuals).any():
        figure, _ = plot.low_order_residuals(data, wavelength_nm, inspection=seen)
        yield picture(figure, f"f11 less a fit of low order, {at}: noise, fine structure, and what stands out.")
    yield "</div>"


def _words(fields: dict[str, str]) -> str:
    body = "\n".join(
        f'<tr><th>{_text(name)}</th><td class="long">{_text(text)}</td></tr>' for name, text in fields.items()
    )
    return f'<div class="scroll"><table><tbody>{body}</tbody></table></div>'


def page(
    data: Dataset,
    data_name: str,
    command: Callable[[Sequence[Finding]], str] | None = None,
    paper: str | None = None,
    origin: dict[str, str] | None = None,
) -> str:
    """The page as HTML text. ``command`` fits the file, in which this was found; without one it is that of a file of this
    name. ``origin`` is of what the page was made."""
    seen = inspect(data)
    title = f"{data_name}: {len(data)} sample{'s' * (len(data) > 1)}"
    parts = [
        f"<h1>{_text(title)}</h1>",
        f'<p class="dim">mmbrdf {__version__}; samples before they are fitted, as mmbrdf inspect sees them</p>',
        "<h2>What the file holds</h2>",
        _contents(data, seen),
        "<h2>What seems to be wrong</h2>",
        *_faults(seen),
        *_pictures(data, seen),
        "<h2>To fit it</h2>",
        f"<pre>{_text((command or partial(fit_command, data_name, None, ()))(seen.findings))}</pre>",
    ]
    if origin:
        parts += ["<h2>Origin</h2>", _words(origin)]
    return document(title, parts, paper)


def fit_command(
    path: str, wavelength_nm: Sequence[float] | None, table_options: Sequence[str], findings: Sequence[Finding]
) -> str:
    """For a shell: `mmbrdf fit data.csv -w 532 -o model.json`, with options that mend what was found."""
    wavelengths = [] if wavelength_nm is None else ["-w", ",".join(f"{nm:.10g}" for nm in wavelength_nm)]
    place = f"./{path}" if path.startswith("-") else path
    options = list(table_options)
    for option, value in (one.remedy.split() for one in findings if one.remedy.startswith("--")):
        if option in options:
            at = options.index(option)
            del options[at : at + 2]
        options += [option, value]
    return shlex.join(["mmbrdf", "fit", place, *wavelengths, *options, "-o", "model.json"])
