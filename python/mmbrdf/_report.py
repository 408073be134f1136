# SPDX-License-Identifier: BSD-3-Clause
"""A report on a model, or on samples before there is one, as one HTML page: what `mmbrdf report` or `mmbrdf inspect` prints,
with pictures. Nothing in it is loaded from elsewhere."""

from __future__ import annotations

import argparse
import base64
import errno
import html
import io
import json
import os
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import Dataset, Model, __version__, load, material, materials, plot, report_json
from ._arguments import number, require
from ._mmbrdf import _to_place_of, _write_text

_STYLE = """
:root { color-scheme: light; --line: #d5d9de; --soft: #f4f6f8; --warn: #fff4d6; --text: #1d2430; --dim: #5b6573; }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--text); margin: 0 auto; padding: 1.5rem; max-width: 64rem; }
h1 { font-size: 1.6rem; margin: 0 0 .2rem; } h2 { font-size: 1.15rem; margin: 2rem 0 .6rem; }
p.dim, figcaption { color: var(--dim); font-size: .87rem; }
ul.warnings { background: var(--warn); border-left: 4px solid #e0a100; padding: .7rem 1rem .7rem 2rem; margin: 1rem 0; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
th, td { padding: .22rem .7rem; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
thead th { background: var(--soft); border-bottom: 2px solid var(--line); }
thead th, thead + tbody td { white-space: nowrap; } thead + tbody td.number { text-align: right; }
table.words thead + tbody td:not(:first-child) { white-space: normal; } pre { background: var(--soft); padding: .6rem 1rem; overflow-x: auto; }
figure { margin: 1rem 0; } figure img { max-width: 100%; height: auto; }
.pair { display: flex; flex-wrap: wrap; gap: 1rem; } .pair figure { flex: 1 1 22rem; }
@media print { body { max-width: none; } h2 { break-after: avoid; } figure { break-inside: avoid; } }
"""


_NORMAL_DEG = 0.2
"""Below this polar angle the azimuth of the source says nothing: both together are within what a map takes for one."""


def _cell(value: Any, uncertainty: float | None = None) -> str:
    if value is None:
        return "<td>not known</td>"
    if isinstance(value, bool):
        return f"<td>{'yes' if value else 'no'}</td>"
    if isinstance(value, (int, float)):
        return f'<td class="number">{_to_place_of(value, uncertainty)}</td>'
    return f"<td>{html.escape(str(value))}</td>"


def _uncertainties(names: list[str]) -> Iterator[str]:
    """Of each column the name of its uncertainty, "" for none: u, or u_ and more, is that of the column before."""
    for name, following in zip(names, [*names[1:], ""]):
        yield next((one for one in (name, following) if one == "u" or one.startswith("u_")), "")


def _table(rows: list[dict[str, Any]]) -> str:
    uncertainties = list(_uncertainties(list(rows[0])))
    head = "".join(f"<th>{html.escape(name)}</th>" for name in rows[0])
    body = "\n".join(
        "<tr>" + "".join(_cell(row[name], row.get(u)) for name, u in zip(row, uncertainties)) + "</tr>" for row in rows
    )
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead>\n<tbody>{body}</tbody></table></div>'


def _section(value: Any) -> str:
    """A field of the facts: a sentence, a list of sentences, a table of names and values, or a table."""
    if isinstance(value, str):
        return f"<p>{html.escape(value)}</p>"
    if not value:
        return "<p>none</p>"
    if isinstance(value, dict):
        rows = "\n".join(f"<tr><th>{html.escape(name)}</th>{_cell(field)}</tr>" for name, field in value.items())
        return f'<div class="scroll"><table><tbody>{rows}</tbody></table></div>'
    if isinstance(value[0], dict):
        return _table(value)
    return "<ul>" + "".join(f"<li>{html.escape(line)}</li>" for line in value) + "</ul>"


def picture(figure: Any, caption: str, kind: str = "png") -> str:
    """The figure within the page: svg for curves, png for maps."""
    buffer = io.BytesIO()
    # Without a date the same model gives the same page.
    figure.savefig(
        buffer, format=kind, dpi=110, bbox_inches="tight", metadata={"Date": None} if kind == "svg" else None
    )
    data = base64.b64encode(buffer.getvalue()).decode("ascii")
    mime = "svg+xml" if kind == "svg" else kind
    text = html.escape(caption)
    return f'<figure><img alt="{text}" src="data:image/{mime};base64,{data}"><figcaption>{text}</figcaption></figure>'


def _model_pictures(model: Model, wavelength_nm: float | None, theta_i_deg: float, phi_i_deg: float) -> Iterator[str]:
    wavelength = "" if wavelength_nm is None else f"{wavelength_nm:g} nm, "
    at = f"{wavelength}theta_i = {theta_i_deg:g}, phi_i = {phi_i_deg:g} degrees"
    yield picture(
        plot.hemisphere(model, wavelength_nm, theta_i_deg, phi_i_deg=phi_i_deg)[0],
        f"The model over the hemisphere of reflected directions, {at}: f11, and the other elements divided by it.",
    )
    yield '<div class="pair">'
    bands = ", with bands of k = 2" if model.has_covariance else ""
    if not {"12", "21", "22"} & set(model.not_measured):
        yield picture(
            plot.in_plane_curves(model, wavelength_nm, theta_i_deg, phi_i_deg=phi_i_deg)[0],
            f"Co- and cross-polarized BRDF in the plane of incidence, {at}{bands}.",
            "svg",
        )
    if not model.not_measured:
        yield picture(
            plot.realizability_map(model, wavelength_nm, theta_i_deg, phi_i_deg=phi_i_deg)[0],
            f"Smallest coherency eigenvalue / f11, {at}: a matrix where it is negative cannot exist.",
        )
    yield "</div>"


def _from_azimuth(data: Dataset, phi_i_deg: float) -> Dataset:
    """Those samples with the source at this azimuth, or so near the normal that it has none."""
    turn = (data.phi_i_deg - phi_i_deg + 180) % 360 - 180
    return data[(np.abs(turn) < 0.4) | (data.theta_i_deg < _NORMAL_DEG)]


def _azimuth_deg(data: Dataset | None) -> float:
    """Of the source in all pictures: that of most samples if they are on a grid, else that of all pictures."""
    usual = plot.disc.SOURCE_AZIMUTH_DEG
    if data is None or not _on_a_grid(data):
        return usual
    azimuths = np.round(data.phi_i_deg[data.theta_i_deg >= _NORMAL_DEG], 1) % 360
    values, counts = np.unique(azimuths, return_counts=True)
    return float(values[counts.argmax()]) if len(values) else usual


def _residual_pictures(model: Model, data: Dataset, wavelength_nm: float, phi_i_deg: float) -> Iterator[str]:
    """At the smallest, a middle and the largest angle of incidence that the data have."""
    here = _from_azimuth(data.at_wavelengths(wavelength_nm), phi_i_deg)
    angles = np.unique(np.round(here.theta_i_deg, 1))
    if len(angles) == 0:
        return
    for theta_i_deg in dict.fromkeys((angles[0], angles[len(angles) // 2], angles[-1])):
        figure, _ = plot.residual_map(model, here, wavelength_nm, float(theta_i_deg), phi_i_deg=phi_i_deg)
        at = f"{wavelength_nm:g} nm, theta_i = {theta_i_deg:g}, phi_i = {phi_i_deg:g} degrees"
        yield picture(figure, f"Samples - model at {at}.")


def _on_a_grid(data: Dataset) -> bool:
    """Whether the samples are many for each direction of the source: then a map of them says something."""
    sources = np.round(np.column_stack([data.wavelength_nm, data.theta_i_deg, data.phi_i_deg]), 1)
    return len(data) >= 50 * len(np.unique(sources, axis=0))


def _spectra(model: Model) -> Iterator[str]:
    for power in range(model.powers + 1):
        caption = f"Coefficients that multiply the wavelength in micrometres to the power {power}."
        yield picture(plot.coefficient_spectrum(model, power=power)[0], caption, "svg")


def _pictures_behind(
    field: str, model: Model, data: Dataset | None, wavelengths_nm: Sequence[float | None], theta_i_deg: float
) -> dict[str, Iterator[str]]:
    """What is shown behind a field of the facts: parts by heading."""
    phi_i_deg = _azimuth_deg(data)
    if field == "fit":
        at = {
            "The model" + ("" if nm is None else f" at {nm:g} nm"): _model_pictures(model, nm, theta_i_deg, phi_i_deg)
            for nm in wavelengths_nm
        }
        return {**at, "Coefficients": _spectra(model)}
    if field == "residuals" and data is not None and _on_a_grid(data):
        maps = (text for nm in data.wavelengths_nm for text in _residual_pictures(model, data, nm, phi_i_deg))
        return {"Residuals on the hemisphere": maps}
    return {}


def _wavelengths(model: Model, data: Dataset | None) -> list[float] | None:
    """At which to report if nobody says it: the first that are known. None: the library knows, or refuses."""
    return list(model.wavelengths_nm or (data.wavelengths_nm if data is not None else ()) or model.reflectance) or None


def _samples_page(
    data: Dataset, data_name: str, wavelength_nm: float | Sequence[float] | None, path: str | None = None
) -> str:
    from . import _inspection

    chosen = None if wavelength_nm is None else [number("wavelength_nm", one) for one in np.atleast_1d(wavelength_nm)]
    data = data if chosen is None else data.at_wavelengths(chosen)
    return _inspection.page(data, data_name, _inspection.fit_command(path or data_name, chosen))


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
    if model is not None or data is None:
        require("model", model, Model)
    if data is not None:
        require("data", data, Dataset)
        if len(data) == 0:
            raise ValueError(f"{data_name}: no samples")
    if model is None:
        return _samples_page(data, data_name, wavelength_nm)
    theta_i_deg = number("theta_i_deg", theta_i_deg)
    if wavelength_nm is None:
        chosen = _wavelengths(model, data)
    else:
        chosen = [number("wavelength_nm", one) for one in np.atleast_1d(wavelength_nm)]
    facts = json.loads(report_json(model, name or model.name or "the model", chosen, data, data_name))
    title = html.escape(facts.pop("title"))
    warnings = facts.pop("warnings")
    alone = "instrument" not in model.provenance
    if model.provenance.get("uncertainty") == "sample":
        source = "of the sample" if alone else "of the sample and its instrument"
    else:
        source = "of the fit alone" if alone else "of the fit and its instrument"
    parts = [
        f"<h1>{title}</h1>",
        f'<p class="dim">mmbrdf {__version__}; uncertainties are standard (k = 1) and {source}</p>',
    ]
    if warnings:
        lines = "".join(f"<li>{html.escape(warning)}</li>" for warning in warnings)
        parts.append(f'<ul class="warnings">{lines}</ul>')
    for field, value in facts.items():
        parts += [f"<h2>{html.escape(field.capitalize().replace('_', ' '))}</h2>", _section(value)]
        for heading, pictures in _pictures_behind(field, model, data, chosen or [None], theta_i_deg).items():
            parts += [f"<h2>{html.escape(heading)}</h2>", *pictures]
    return document(title, parts, escaped=True)


def document(title: str, parts: Sequence[str], *, escaped: bool = False) -> str:
    """A whole page of these parts."""
    title = title if escaped else html.escape(title)
    body = "\n".join(parts)
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{title}</title>\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1"><style>{_STYLE}</style></head>\n'
        f"<body>\n{body}\n</body></html>\n"
    )


def write(path: str | os.PathLike[str], text: str | bytes) -> None:
    """All of it or nothing: links are followed, modes kept, devices written directly."""
    if not Path(path).parent.exists():
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), os.fspath(path))
    _write_text(path, text)


def _require_kept(output: str, inputs: Sequence[str | None]) -> None:
    """Raises ValueError if the page would take the place of what it is about, under whatever names and links."""
    for name in inputs:
        if name and os.path.isfile(output) and os.path.exists(name) and os.path.samefile(output, name):
            raise ValueError(f"{output}: would overwrite {name}")


def _opened(name: str) -> Model | Dataset:
    return material(name) if name in materials() else load(name)


def _page_of(options: argparse.Namespace) -> str:
    """Of a model with or without samples, or of samples."""
    model = _opened(options.model)
    if isinstance(model, Dataset) and options.data is None:
        return _samples_page(model, Path(options.model).name, options.wavelength, options.model)
    data = load(options.data) if options.data else None
    for name, thing, kind in ((options.model, model, Model), (options.data, data, Dataset)):
        if thing is not None and not isinstance(thing, kind):
            raise ValueError(f"{name}: expected a {kind.__name__.lower()}")
    names = {"name": Path(options.model).name, "data_name": Path(options.data or "").name}
    return page(model, data, wavelength_nm=options.wavelength, theta_i_deg=options.theta_i, **names)


def main(arguments: Sequence[str] | None = None) -> int:
    """python3 -m mmbrdf.report"""
    parser = argparse.ArgumentParser(prog="python3 -m mmbrdf.report", description=__doc__)
    parser.add_argument(
        "model",
        metavar="MODEL",
        help="built-in name, JSON model or coefficient CSV; or DATA.csv alone, before it is fitted",
    )
    parser.add_argument("data", metavar="DATA.csv", nargs="?", help="samples to set beside a model")
    parser.add_argument("-o", "--output", metavar="REPORT.html", required=True, help="where the page goes")
    parser.add_argument("-w", "--wavelength", metavar="NM", type=float, nargs="+", help="wavelengths to report on")
    parser.add_argument(
        "--theta-i", metavar="DEG", type=float, default=45, help="angle of incidence of the pictures of a model [45]"
    )
    options = parser.parse_args(arguments)
    built_in = options.model in materials()
    try:
        _require_kept(options.output, [options.data] if built_in else [options.model, options.data])
        write(options.output, _page_of(options))
    except (OSError, ValueError) as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        return 1
    return 0
