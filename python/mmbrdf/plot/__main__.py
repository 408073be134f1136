# SPDX-License-Identifier: BSD-3-Clause
"""Draws a picture of mmbrdf.plot: python3 -m mmbrdf.plot KIND MODEL [DATA.csv] -o FILE.pdf

KIND is the name of a function of mmbrdf.plot, MODEL a built-in name, a model or samples; what each kind takes and shows is in
help(mmbrdf.plot.map) and the like. --columns, --skip-incomplete, --frame and --convention say of samples what their table does
not, as in all commands; --shown-frame is the frame of the picture.
"""

import argparse
import inspect
import io
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .. import Dataset, Model, _table_options, load_instrument, material, materials, plot
from .._files import said
from .._report import _require_kept, titled, write

FORMATS = (".pdf", ".png", ".svg")

_SOURCES: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "anisotropy": (("model",), ()),
    "by-wavelength": (("model",), ()),
    "calibration": (("instrument", "references"), ()),
    "coefficient-spectrum": (("model",), ()),
    "depolarization-map": (("any",), ()),
    "directions": (("data",), ()),
    "hemisphere": (("any",), ()),
    "in-plane-curves": (("model",), ("data",)),
    "low-order-residuals": (("data",), ()),
    "map": (("any",), ("minus",)),
    "polar-in-plane": (("model",), ()),
    "realizability-map": (("any",), ()),
    "reflectance-against-angle": (("model",), ()),
    "reflectance-against-wavelength": (("model",), ()),
    "reflectance-factor": (("model",), ()),
    "residual-map": (("model", "data"), ()),
    "residuals": (("model", "data"), ()),
    "suspicious": (("data",), ()),
    "uncertainty-parts": (("model",), ()),
}
"""What each kind is drawn of, and what may be drawn with it: kinds of files, the latter names of arguments, too."""

_SEVERAL_NM = {
    "by-wavelength",
    "polar-in-plane",
    "reflectance-against-angle",
    "reflectance-against-wavelength",
    "reflectance-factor",
    "residuals",
}
_SEVERAL_DEG = {"reflectance-against-angle", "reflectance-against-wavelength", "reflectance-factor"}


def _parser(prog: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=prog,
        usage="%(prog)s KIND MODEL [DATA.csv] -o FILE.pdf [options]",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="kinds: " + ", ".join(_SOURCES),
    )
    add = parser.add_argument
    add("kind", metavar="KIND", choices=_SOURCES, help="of picture, see below")
    add(
        "sources", metavar="MODEL", nargs="+", help="built-in name, model, samples or instrument, and what goes with it"
    )
    add("-o", "--output", metavar="FILE", required=True, help="where it goes: .pdf, .png or .svg")
    add("-w", "--wavelength", dest="wavelength_nm", metavar="NM[,NM...]", type=_list, nargs="+", help="wavelengths")
    add("-i", "--theta-i", dest="theta_i_deg", metavar="DEG[,DEG...]", type=_list, nargs="+", help="incidence [45]")
    add("--phi-i", dest="phi_i_deg", metavar="DEG", type=float, help="azimuth of the source [180]")
    add("--shown-frame", dest="frame", choices=_table_options.FRAMES, help="of the matrices in the picture [xy]")
    add("--quantity", metavar="NAME", help="of a map or of uncertainty-parts: 11, 22, depolarization, dhr, ...")
    add("--stokes", metavar="S1,S2,S3,S4", help="incident light, of a map of what becomes of it")
    add("--show", choices=("value", "u", "value / u"), help="what of it a map shows")
    add("--over-u", action="store_true", default=None, help="residuals over their standard uncertainty")
    add("--scale", choices=("data", "paper"), help="limits of what is shown, or those of the paper")
    add(
        "--view",
        dest="views",
        metavar="THETA,PHI",
        action="append",
        help="detector of a reflectance factor, from the source's azimuth",
    )
    add("--term", dest="terms", metavar="KIND=U", action="append", help="of type B: scale=0.3%%, theta_r=0.02deg")
    add("--coverage", metavar="K", type=float, help="standard uncertainties to each side of a band [2]")
    add("--power", metavar="N", type=int, help="of the wavelength, of a coefficient-spectrum [0]")
    add("--film", metavar="INDEX,UM,N,K", help="of the wafers of a calibration")
    add("--dial-sense", type=int, choices=(1, -1), help="of the polarizer of a calibration")
    _table_options.add_to(parser)
    add("--width", dest="width_cm", metavar="CM", type=float, help="of the figure: 8 and 17 are columns of a journal")
    add("--dpi", metavar="N", type=float, default=300, help="dots per inch of a PNG [300]")
    return parser


def _list(text: str) -> list[float]:
    """443,555: as the program has them; blanks between them are taken, too."""
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: expected numbers, as in 443,555") from None


def _numbers(text: str, count: int, name: str) -> list[float]:
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    if len(values) != count:
        raise ValueError(f"{name} {text}: expected {count} numbers")
    return values


def _term(text: str) -> tuple[str, float]:
    """As the program's: scale=0.3%, theta_r=0.02deg, calibration=0.001."""
    name, equals, value = text.partition("=")
    if not equals:
        raise ValueError(f"--term {text}: expected NAME=VALUE")
    if value.endswith("deg"):
        name, value = name.removesuffix("_deg") + "_deg", value.removesuffix("deg")
    percent = value.endswith("%")
    number = _numbers(value.removesuffix("%"), 1, f"--term {name}:")[0]
    return name, number / 100 if percent else number


def _terms(texts: Sequence[str]) -> dict[str, float]:
    terms: dict[str, float] = {}
    for text in texts:
        name, value = _term(text)
        if name in terms:
            raise ValueError(f"--term {text}: {name} is given twice; two errors are one of the root of their squares")
        terms[name] = value
    return terms


def _converted(name: str, value: Any, kind: str) -> Any:
    """An option as the function takes it."""
    if name in ("wavelength_nm", "theta_i_deg"):
        value = [number for part in value for number in part]
    if name == "wavelength_nm" and kind not in _SEVERAL_NM or name == "theta_i_deg" and kind not in _SEVERAL_DEG:
        if len(value) != 1:
            raise ValueError(f"{kind} takes one {'wavelength' if name == 'wavelength_nm' else 'angle of incidence'}")
        return value[0]
    if name == "views":
        return [tuple(_numbers(text, 2, "--view")) for text in value]
    if name == "stokes":
        return _numbers(value, 4, "--stokes")
    if name == "terms":
        return _terms(value)
    if name == "film":
        n, thickness_um, substrate, k = _numbers(value, 4, "--film")
        return n, thickness_um, complex(substrate, k)
    return value


def _opened(name: str, kind: str, options: argparse.Namespace) -> Any:
    if kind == "references":
        return name
    if kind == "instrument":
        return load_instrument(name)
    thing = material(name) if name in materials() else _table_options.opened(name, options)
    wanted = {"any": (Model, Dataset), "data": (Dataset,)}.get(kind, (Model,))
    if not isinstance(thing, wanted):
        raise ValueError(f"{name}: expected {'samples' if kind == 'data' else 'a model'}")
    return titled(thing, Path(name).name) if isinstance(thing, Model) and name not in materials() else thing


def _note(options: argparse.Namespace, things: Sequence[Any], who: str) -> None:
    """How tables were understood. Raises ValueError where options are of a table, and there is none."""
    tables = {name: thing for name, thing in zip(options.sources, things) if isinstance(thing, Dataset)}
    if not tables and (flags := _table_options.given(options)):
        shown = ", --shown-frame that of the picture" if "--frame" in flags else ""
        raise ValueError(f"{', '.join(flags)}: of a table of samples{shown}, and {options.sources[0]} is none")
    for name, data in tables.items():
        if data.read_as:
            print(f"{who}: note: {Path(name).name}: {data.read_as}", file=sys.stderr)


def _drawn(options: argparse.Namespace, asked: dict[str, Any], who: str) -> Any:
    """The figure that was asked for."""
    function = getattr(plot, options.kind.replace("-", "_"))
    needed, more = _SOURCES[options.kind]
    things = [_opened(name, kind, options) for name, kind in zip(options.sources, needed + more)]
    _note(options, things, who)
    arguments = {name: _converted(name, value, options.kind) for name, value in asked.items()}
    arguments.update(zip(more, things[len(needed) :]))
    names = list(inspect.signature(function).parameters)[: len(needed)]
    arguments.update(zip(names, things))
    if "wavelength_nm" in inspect.signature(function).parameters:
        arguments.setdefault("wavelength_nm", None)
    if options.kind in ("hemisphere", "residual-map", "depolarization-map", "realizability-map"):
        arguments.setdefault("theta_i_deg", 45.0)
    return function(**arguments)[0]


def _saved(figure: Any, path: str, dpi: float) -> None:
    """All of it or nothing."""
    kind = Path(path).suffix[1:].lower()
    buffer = io.BytesIO()
    # Without a date the same question gives the same file.
    metadata = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}.get(kind)
    figure.savefig(buffer, format=kind, dpi=dpi, metadata=metadata)
    write(path, buffer.getvalue())


def main(arguments: Sequence[str] | None = None, prog: str = "python3 -m mmbrdf.plot") -> int:
    """Exit status: 0, 1 for bad input, 2 for wrong usage."""
    parser = _parser(prog)
    options = parser.parse_args(arguments)
    if Path(options.output).suffix.lower() not in FORMATS:
        parser.error(f"-o {options.output}: expected a file that ends with {', '.join(FORMATS)}")
    needed, more = _SOURCES[options.kind]
    if not len(needed) <= len(options.sources) <= len(needed + more):
        parser.error(
            f"{options.kind} takes {' and '.join(needed)}" + "".join(f", and may take {name}" for name in more)
        )
    known = inspect.signature(getattr(plot, options.kind.replace("-", "_"))).parameters
    own = ("kind", "sources", "output", "dpi", *_table_options.FLAGS)
    asked = {name: value for name, value in vars(options).items() if value is not None and name not in own}
    for name in asked:
        if name not in known:
            flag = next(f for a in parser._actions if a.dest == name for f in a.option_strings if f.startswith("--"))
            parser.error(f"{options.kind} takes no {flag}")
    try:
        _require_kept(options.output, [name for name in options.sources if name not in materials()])
        _saved(
            _drawn(options, asked, prog.split()[0] if prog.startswith("mmbrdf") else prog), options.output, options.dpi
        )
    except (OSError, ValueError, TypeError) as error:
        print(f"{parser.prog}: {said(error)}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
