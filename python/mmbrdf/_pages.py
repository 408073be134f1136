# SPDX-License-Identifier: BSD-3-Clause
"""Documents of blocks as HTML pages: what they look like on a screen and on A4 and Letter. Nothing in a page is loaded from
elsewhere."""

from __future__ import annotations

import base64
import html
import io
import re
from collections.abc import Callable, Iterator, Sequence
from typing import Any

PAPERS = {"a4": "A4", "letter": "Letter"}

_STYLE = """
:root { color-scheme: light; --line: #cfd4da; --soft: #f4f6f8; --warn: #fff4d6; --text: #1d2430; --dim: #4f5966; }
* { box-sizing: border-box; }
body { font: 15px/1.5 "DejaVu Sans", system-ui, sans-serif; color: var(--text); margin: 0 auto; padding: 1.5rem;
  max-width: 64rem; overflow-wrap: break-word; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0 0 .4rem; overflow-wrap: anywhere; }
h2 { font-size: 1.15rem; line-height: 1.3; margin: 2rem 0 .5rem; }
p { margin: .5rem 0; } p.dim, figcaption, .remark { color: var(--dim); font-size: .87rem; }
p.summary { font-size: 1.07em; border-left: 4px solid #12408c; padding: .1rem 0 .1rem 1rem; margin: 1rem 0; }
.list { padding: .5rem 1rem; margin: 1rem 0; break-inside: avoid; } .list p { margin: 0; font-weight: 600; }
.list ul { margin: .2rem 0 0; padding-left: 1.2rem; } .list li { overflow-wrap: anywhere; }
.warnings { background: var(--warn); border-left: 4px solid #e0a100; } .notes { background: var(--soft); border-left: 4px solid #9aa4b1; }
nav { columns: 2; font-size: .92rem; margin: 1rem 0; } nav a { color: inherit; text-decoration: none; display: block; }
nav a:hover { text-decoration: underline; }
figure { margin: 1rem 0 1.4rem; } figcaption b { color: var(--text); }
figure.table figcaption { margin-bottom: .35rem; } figure.picture figcaption { margin-top: .4rem; }
table.wide td.long { min-width: 6.5rem; } table.wide th, table.wide td { padding-left: .3rem; padding-right: .3rem; }
figure img { display: block; max-width: 100%; height: auto; }
.pair { display: flex; flex-wrap: wrap; gap: 0 .6rem; align-items: flex-start; } .pair figure { flex: 0 0 auto; }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; max-width: 100%; }
th, td { padding: .2rem .55rem; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
thead th { background: var(--soft); border-bottom: 2px solid var(--line); vertical-align: bottom; }
td.right, th.right { text-align: right; } td.right { white-space: nowrap; } td.long { overflow-wrap: anywhere; }
tbody th { font-weight: 600; white-space: nowrap; }
pre { background: var(--soft); padding: .6rem 1rem; white-space: pre-wrap; overflow-wrap: anywhere; }
@media screen { .scroll { overflow-x: auto; } }
@media print {
  body { max-width: none; padding: 0; font-size: 9.2pt; line-height: 1.4; }
  h1 { font-size: 17pt; } h2 { font-size: 12pt; margin-top: 1.4rem; break-after: avoid; }
  p { orphans: 3; widows: 3; } table { font-size: 7.8pt; } th, td { padding: .12rem .4rem; }
  figcaption, .remark { font-size: 8pt; } nav { font-size: 8.6pt; }
  thead { display: table-header-group; } tr, figure:not(.long), .list, p.summary, pre { break-inside: avoid; }
  figcaption { break-after: avoid; } figure.picture figcaption { break-before: avoid; break-after: auto; }
}
@page { margin: 17mm 17mm 19mm; }
"""

_RASTER = {"hemisphere", "realizability-map", "residual-map", "residuals", "by-wavelength"}
"""Kinds of pictures that are maps or clouds of points: as pixels they are smaller, and browsers draw them alike."""

_DPI = 220
_HALF_CM = 8.5
_FEW_COLUMNS = 8
_ROWS_THAT_STAY = 24
"""Tables of more rows may go on on the next page."""


def _in_css(text: str) -> str:
    """In quotes of a style sheet."""
    return '"' + re.sub(r"[^ -!#-;=?-\[\]-~]", lambda found: f"\\{ord(found[0]):x} ", text) + '"'


def _paper_style(title: str, paper: str) -> str:
    """The paper, the title and the numbers of its pages."""
    small = 'font: 7.5pt "DejaVu Sans", sans-serif; color: #4f5966;'
    return (
        f"@page {{ size: {PAPERS[paper]}; @bottom-left {{ content: {_in_css(title[:90])}; {small} }}"
        f' @bottom-right {{ content: counter(page) " / " counter(pages); {small} }} }}\n'
    )


def document(title: str, parts: Sequence[str], paper: str | None = None) -> str:
    """A whole page of these parts of HTML; ``title`` is text."""
    name = html.escape(title)
    body = "\n".join(parts)
    style = _STYLE + ("" if paper is None else _paper_style(title, paper))
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{name}</title>\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1"><style>{style}</style></head>\n'
        f"<body>\n{body}\n</body></html>\n"
    )


def _text(words: str) -> str:
    """Words as HTML, with subscripts, and unbroken between a sign and its numbers."""
    escaped = html.escape(words)
    for index, letter in (("ᵢ", "i"), ("ᵣ", "r")):
        escaped = escaped.replace(index, f"<sub>{letter}</sub>")
    return re.sub(r" ([=±×≤]) ", "\u00a0\\1\u00a0", escaped).replace(" nm", "\u00a0nm").replace(" sr⁻¹", "\u00a0sr⁻¹")


def image(figure: Any, alt: str, kind: str, width_cm: float | None = None) -> str:
    """A figure of matplotlib within a page, as svg or png; the same figure gives the same text."""
    from matplotlib import rc_context

    buffer = io.BytesIO()
    options: dict[str, Any] = dict(dpi=110, bbox_inches="tight") if width_cm is None else dict(dpi=_DPI)
    with rc_context({"svg.hashsalt": "mmbrdf"}):
        figure.savefig(buffer, format=kind, metadata={"Date": None} if kind == "svg" else None, **options)
    data = base64.b64encode(buffer.getvalue()).decode("ascii")
    size = "" if width_cm is None else f' style="width: {width_cm:g}cm"'
    return f'<img alt="{html.escape(alt)}"{size} src="data:image/{"svg+xml" if kind == "svg" else kind};base64,{data}">'


def picture(figure: Any, caption: str, kind: str = "png") -> str:
    """A figure below which there is its caption."""
    text = html.escape(caption)
    return f'<figure class="picture">{image(figure, caption, kind)}<figcaption>{text}</figcaption></figure>'


def _list(kind: str, lines: Sequence[str]) -> str:
    items = "".join(f"<li>{_text(line)}</li>" for line in lines)
    return f'<div class="list {kind}"><p>{kind.capitalize()}</p><ul>{items}</ul></div>'


def _table(block: dict[str, Any]) -> str:
    aligned = [column["align"] for column in block["columns"]]
    of_names = not any(column["heading"] for column in block["columns"])
    head = "".join(
        f'<th class="{side}">{_text(column["heading"])}</th>' for side, column in zip(aligned, block["columns"])
    )
    rows = []
    for row in block["rows"]:
        cells = [
            f'<td class="{side if side == "right" else "long"}">{_text(cell)}</td>' for side, cell in zip(aligned, row)
        ]
        if of_names:
            cells[0] = f"<th>{_text(row[0])}</th>"
        rows.append("<tr>" + "".join(cells) + "</tr>")
    table = (
        f'<table class="{"wide" if len(aligned) > _FEW_COLUMNS else "narrow"}">'
        + ("" if of_names else f"<thead><tr>{head}</tr></thead>")
        + f"<tbody>{chr(10).join(rows)}</tbody></table>"
    )
    caption = f'<figcaption><b>Table {block["number"]}.</b> {_text(block["caption"])}</figcaption>'
    remark = f'<p class="remark">{_text(block["remark"])}</p>' if "remark" in block else ""
    long = " long" if len(rows) > _ROWS_THAT_STAY else ""
    return f'<figure class="table{long}">{caption}<div class="scroll">{table}</div>{remark}</figure>'


def _figure(block: dict[str, Any], drawn: Any) -> str:
    kind = "png" if block["plot"] in _RASTER else "svg"
    caption = f'<figcaption style="max-width: {block["width_cm"]:g}cm"><b>Figure {block["number"]}.</b> {_text(block["caption"])}</figcaption>'
    return f'<figure class="picture">{image(drawn, block["caption"], kind, block["width_cm"])}{caption}</figure>'


def _contents(blocks: Sequence[dict[str, Any]]) -> str:
    links = "".join(
        f'<a href="#{html.escape(block["anchor"])}">{_text(block["text"])}</a>'
        for block in blocks
        if block["kind"] == "heading"
    )
    return f"<nav>{links}</nav>"


def parts(blocks: Sequence[dict[str, Any]], draw: Callable[[dict[str, Any]], Any]) -> Iterator[str]:
    """The blocks of a report's document as HTML. ``draw`` makes the figure of a block."""
    pair: list[str] = []
    for block in [*blocks, {"kind": "end"}]:
        kind = block["kind"]
        if kind == "figure" and block["width_cm"] <= _HALF_CM:
            pair.append(_figure(block, draw(block)))
            continue
        if pair:
            yield '<div class="pair">' + "".join(pair) + "</div>"
            pair = []
        if kind == "figure":
            yield _figure(block, draw(block))
        elif kind == "heading":
            yield f'<h2 id="{html.escape(block["anchor"])}">{_text(block["text"])}</h2>'
        elif kind == "summary":
            yield f'<p class="summary"><b>{html.escape(block["subject"])}</b>{_text(block["text"])}</p>'
        elif kind == "paragraph":
            yield f'<p>{_text(block["text"])}</p>'
        elif kind in ("warnings", "notes") and block["lines"]:
            yield _list(kind, block["lines"])
        elif kind == "warnings":
            yield "<p>There is nothing to warn of within the fitted range.</p>"
        elif kind == "contents":
            yield _contents(blocks)
        elif kind == "table":
            yield _table(block)
