# SPDX-License-Identifier: BSD-3-Clause
"""The functions of the package as Python calls them: their signatures, and in one line what is wrong with the arguments of a call.

Each function and method of the compiled part is wrapped once, when the package is imported. What it takes is read from the first
line of its documentation, which pybind11 writes; what functions of Python take, from their annotations.
"""

from __future__ import annotations

import ast
import difflib
import functools
import inspect
import operator
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np


class Argument(NamedTuple):
    """Of a function; wanted is the type as the documentation has it, default its text, None: it must be given."""

    name: str
    wanted: str
    default: str | None
    by_name: bool


_MARKS = re.compile(r"[\[\](){}<>,'\"]")


def split(text: str) -> list[str]:
    """At the commas outside of brackets and quotes."""
    parts, depth, quote, start = [], 0, "", 0
    for mark in _MARKS.finditer(text):
        place, letter = mark.start(), mark[0]
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "'\"":
            quote = letter
        elif letter in "([{<":
            depth += 1
        elif letter in ")]}" or (letter == ">" and text[place - 1] != "-"):
            depth -= 1
        elif letter == "," and depth == 0:
            parts.append(text[start:place].strip())
            start = place + 1
    return [part for part in [*parts, text[start:].strip()] if part]


def arguments_of(signature: str) -> list[Argument]:
    """Of "evaluate(self: mmbrdf._mmbrdf.Model, frame: str = 'xy') -> object"."""
    inner = signature[signature.index("(") + 1 : signature.rindex(")")] if "(" in signature else ""
    result, by_name = [], False
    for part in split(inner):
        if part == "*":
            by_name = True
            continue
        name, _, rest = part.partition(": ")
        wanted, _, default = rest.partition(" = ")
        result.append(Argument(name, wanted, default or None, by_name))
    return result


def signature_of(arguments: Sequence[Argument]) -> inspect.Signature:
    """As help() shows it. An argument in front of one that must be given has no default there."""
    kind = inspect.Parameter
    last = max((n for n, one in enumerate(arguments) if one.default is None and not one.by_name), default=-1)
    return inspect.Signature(
        [
            kind(
                one.name,
                kind.KEYWORD_ONLY if one.by_name else kind.POSITIONAL_OR_KEYWORD,
                default=kind.empty if one.default is None or n < last else _value(one.default),
            )
            for n, one in enumerate(arguments)
        ]
    )


@functools.lru_cache
def _value(text: str) -> Any:
    try:
        return ast.literal_eval(text)
    except (SyntaxError, ValueError):
        return float(text) if text in ("inf", "nan", "-inf") else text


# ---- what is wanted --------------------------------------------------------------------------------------------------

_WORDS = {
    "str": "text",
    "bool": "True or False",
    "int": "a whole number",
    "float": "a number",
    "complex": "a complex number",
    "os.PathLike": "a path",
    "dict": "a dict",
    "list": "a list",
    "sequence": "a sequence",
    "tuple": "a tuple",
    "bytes": "bytes",
    "iterable": "a sequence",
    "mapping": "a dict",
    "callable": "a function",
}


def _inner(wanted: str) -> tuple[str, list[str]]:
    head, _, rest = wanted.partition("[")
    return head, split(rest[:-1]) if rest else []


def in_words(wanted: str) -> str:
    """A type for people: "a number", "mmbrdf.Model"."""
    head, inner = _inner(wanted)
    if head == "Optional":
        return in_words(inner[0])
    if head == "Union":
        return " or ".join(map(in_words, inner))
    if head == "Tuple":
        return f"a tuple ({', '.join(map(in_words, inner))})"
    if head == "List":
        return f"a sequence, each {in_words(inner[0])}"
    if head == "Dict":
        return f"a dict {{{': '.join(map(in_words, inner))}}}"
    if head.startswith("numpy.ndarray"):
        return "an array"
    return _WORDS.get(head, "mmbrdf." + head.rpartition(".")[2] if head.startswith("mmbrdf.") else head)


def _converts(convert: Callable[[Any], Any]) -> Callable[[Any], bool]:
    def fits(value: Any) -> bool:
        try:
            convert(value)
        except (TypeError, ValueError):
            return False
        return not isinstance(value, (str, bytes))

    return fits


_FITS: dict[str, Callable[[Any], bool]] = {
    "str": lambda value: isinstance(value, (str, bytes)),
    "bool": lambda value: isinstance(value, (bool, np.bool_)),
    "int": _converts(operator.index),
    "float": _converts(float),
    "complex": _converts(complex),
    "os.PathLike": lambda value: isinstance(value, (str, bytes, os.PathLike)),
    "dict": lambda value: isinstance(value, dict),
    "list": lambda value: isinstance(value, list),
    "tuple": lambda value: isinstance(value, tuple),
    "sequence": lambda value: hasattr(value, "__getitem__") and hasattr(value, "__len__"),
    "iterable": lambda value: hasattr(value, "__iter__") or hasattr(value, "__getitem__"),
    "mapping": lambda value: isinstance(value, Mapping),
    "callable": callable,
}


def fits(value: Any, wanted: str, default: str | None = None) -> bool:
    """Whether a value may be what is wanted. True of what is not known here."""
    head, inner = _inner(wanted)
    if value is None and (head == "Optional" or default == "None"):
        return True
    if head in ("Optional", "Union"):
        return any(fits(value, one) for one in inner)
    if head in ("Tuple", "List"):
        if isinstance(value, (str, bytes)) or not _FITS["sequence"](value):
            return False
        if head == "List":
            return all(fits(one, inner[0]) for one in value)
        return len(value) == len(inner) and all(map(fits, value, inner))
    if head == "Dict":
        return isinstance(value, dict) and all(fits(k, inner[0]) and fits(v, inner[1]) for k, v in value.items())
    if head.startswith("numpy.ndarray"):
        return isinstance(value, np.ndarray)
    if head.startswith(("mmbrdf.", "matplotlib.")):
        return any(one.__name__ == head.rpartition(".")[2] for one in type(value).__mro__)
    return _FITS.get(head, lambda _: True)(value)


def refusal(name: str, wanted: str, value: Any) -> str:
    """What a TypeError says of the argument called ``name``; wanted in words."""
    kind = type(value).__name__
    hint = ": its .model is one" if kind == "FitResult" and "mmbrdf.Model" in wanted else ""
    shown = f" {value!r}" if isinstance(value, (str, int, float)) and len(repr(value)) < 40 else ""
    return f"{name}: expected {wanted}, not {kind}{shown}{hint}"


# ---- what is wrong ---------------------------------------------------------------------------------------------------


def _and(names: Sequence[str]) -> str:
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


def faults(arguments: Sequence[Argument], given: Sequence[Any], named: Mapping[str, Any]) -> Iterator[str]:
    """What is wrong with a call, the worst first."""
    placed = [one for one in arguments if not one.by_name]
    known = {one.name: one for one in arguments}
    for name in named:
        if name not in known:
            near = difflib.get_close_matches(name, known, 1, 0.5) or [one for one in known if name in one][:1]
            yield f"there is no argument {name}" + (f", but {near[0]}" if near else "")
    if len(given) > len(placed):
        names = [one.name for one in arguments if one.by_name]
        others = f"; {_and(names)} must be named" if names else ""
        at_most = len(placed) - (bool(placed) and placed[0].name == "self")
        yield f"takes {at_most or 'no'} argument{'s' * (at_most != 1)} without a name, not {len(given) - len(placed) + at_most}{others}"
    values = dict(zip((one.name for one in placed), given))
    twice = [name for name in named if name in values]
    if twice:
        yield f"{_and(twice)} is given twice"
    values.update(named)
    missing = [one for one in arguments if one.default is None and one.name not in values and one.name != "self"]
    if missing:
        kinds = {in_words(one.wanted) for one in missing} - {"object"}
        yield f"{_and([one.name for one in missing])} missing" + (
            f": expected {kinds.pop()}" if len(kinds) == 1 else ""
        )
    for name, value in values.items():
        if name in known and not fits(value, known[name].wanted, known[name].default):
            yield refusal(name, in_words(known[name].wanted), value)


def signatures(documentation: str) -> list[str]:
    """All of a function; of one with overloads those of each."""
    lines = (documentation or "").splitlines()
    if len(lines) > 1 and lines[1] == "Overloaded function.":
        return [line.partition(". ")[2] for line in lines[2:] if line[:1].isdigit() and ". " in line]
    return lines[:1]


def explained(name: str, documentation: str, given: Sequence[Any], named: Mapping[str, Any]) -> str:
    """What is wrong with a call of a compiled function, in one line."""
    found = [list(faults(arguments_of(one), given, named)) for one in signatures(documentation)]
    best = min(found, key=len, default=[])
    return (
        f"{name}: {best[0]}" if best else f"{name}: these arguments do not go together; help(mmbrdf.{name}) has those"
    )


_NOT_THESE = re.compile(r"incompatible (function|constructor) arguments")
"""What pybind11 says of arguments that fit no signature."""


def wrapped(function: Callable[..., Any], name: str, documentation: str | None = None) -> Callable[..., Any]:
    """The same function, whose TypeError is one line. ``name`` as users call it: "Model.save"."""
    text = function.__doc__ or "" if documentation is None else documentation

    takes = arguments_of(signatures(text)[0]) if inspect.isfunction(function) else None

    @functools.wraps(function)
    def call(*given: Any, **named: Any) -> Any:
        if takes is not None:  # of Python, which looks at nothing itself
            for wrong in faults(takes, given, named):
                raise TypeError(f"{name}: {wrong}")
        try:
            return function(*given, **named)
        except TypeError as error:
            if not _NOT_THESE.search(str(error)):
                raise
            wrong = explained(name, text, given, named)
        raise TypeError(wrong)

    return dressed(call, name, text)


def dressed(call: Callable[..., Any], name: str, documentation: str) -> Callable[..., Any]:
    """The function with what help(), inspect and pickle ask it for."""
    del call.__wrapped__
    call.__module__, call.__qualname__, call.__doc__ = "mmbrdf._mmbrdf", name, documentation
    if len(signatures(documentation)) == 1:
        call.__signature__ = signature_of(arguments_of(signatures(documentation)[0]))
    return call


# ---- functions of Python ---------------------------------------------------------------------------------------------

_ANNOTATED = {name: name for name in ("str", "bool", "int", "float", "complex", "os.PathLike")}
_ANNOTATED |= {
    "Sequence": "iterable",
    "Iterable": "iterable",
    "Mapping": "mapping",
    "dict": "mapping",
    "Callable": "callable",
}
_ANNOTATED |= {name: f"mmbrdf.{name}" for name in ("Model", "Dataset", "FitResult", "Polarimeter", "Calibration")}
_ANNOTATED |= {name: f"matplotlib.{name}" for name in ("Axes", "PolarAxes", "Figure", "SubFigure")}
_BETWEEN = re.compile(r"\|(?![^\[]*\])")


def _wanted(annotation: Any) -> str:
    """A type as the documentation of the compiled part has it; "object" of what the function looks at itself."""
    kinds = [kind.strip().lstrip("_").partition("[")[0] for kind in _BETWEEN.split(str(annotation))]
    known = list(dict.fromkeys(_ANNOTATED.get(kind, "object") for kind in kinds if kind != "None"))
    known = [kind for kind in known if kind != "str" or "os.PathLike" not in known]  # which text is, too
    if "object" in known:
        return "object"
    wanted = known[0] if len(known) == 1 else f"Union[{', '.join(known)}]"
    return f"Optional[{wanted}]" if "None" in kinds else wanted


def arguments_in_python(function: Callable[..., Any]) -> list[Argument]:
    """As they are annotated, but for **others."""
    return [
        Argument(
            one.name, _wanted(one.annotation), None if one.default is one.empty else "", one.kind is one.KEYWORD_ONLY
        )
        for one in inspect.signature(function).parameters.values()
        if one.kind is not one.VAR_KEYWORD
    ]


F = TypeVar("F", bound=Callable[..., Any])


def told_in_a_line(name: str, module: str | None = None) -> Callable[[F], F]:
    """Makes of a function of Python one whose TypeError is one line. ``name`` and ``module`` as users find it."""

    def wrap(function: F) -> F:
        takes = arguments_in_python(function)
        known = {one.name for one in takes}
        any_name = len(takes) < len(inspect.signature(function).parameters)

        @functools.wraps(function)
        def call(*given: Any, **named: Any) -> Any:
            looked_at = {name: value for name, value in named.items() if name in known} if any_name else named
            for wrong in faults(takes, given, looked_at):
                raise TypeError(f"{name}: {wrong}")
            return function(*given, **named)

        del call.__wrapped__  # type: ignore[attr-defined]
        call.__signature__ = inspect.signature(function)  # type: ignore[attr-defined]
        call.__module__ = module or function.__module__
        return call  # type: ignore[return-value]

    return wrap


def tell_in_a_line(package: dict[str, Any], names: Iterable[str], prefix: str) -> None:
    """Does so with functions, and with what classes have, of a package."""
    for name in names:
        thing = package[name]
        if inspect.isfunction(thing):
            package[name] = told_in_a_line(f"{prefix}.{name}", package["__name__"])(thing)
        elif inspect.isclass(thing) and not issubclass(thing, tuple):
            for member, value in list(vars(thing).items()):
                function = value.__func__ if isinstance(value, staticmethod) else value
                if inspect.isfunction(function) and (member == "__init__" or not member.startswith("_")):
                    told = told_in_a_line(name if member == "__init__" else f"{name}.{member}")(function)
                    setattr(thing, member, staticmethod(told) if isinstance(value, staticmethod) else told)


# ---- the compiled part -----------------------------------------------------------------------------------------------


def install(module: Any, wrap: Callable[..., Any] = wrapped) -> None:
    """Wraps all functions, public methods and constructors of the compiled part."""
    for name, thing in list(vars(module).items()):
        if inspect.isclass(thing):
            _install_methods(thing, wrap)
        elif callable(thing) and not name.startswith("__"):
            setattr(module, name, wrap(thing, name))


def install_function(cls: type, function: Callable[..., Any], wrap: Callable[..., Any]) -> None:
    """A method that is written in Python, with its signature in the first line of its documentation as those of pybind11."""
    setattr(cls, function.__name__, wrap(function, f"{cls.__name__}.{function.__name__}"))


def _nobody_makes(cls: type) -> Callable[..., None]:
    def __init__(self: Any, *given: Any, **named: Any) -> None:
        raise TypeError(f"{cls.__name__}: functions give it, it has no constructor")

    return __init__


def _install_methods(cls: type, wrap: Callable[..., Any]) -> None:
    for name, member in list(vars(cls).items()):
        if isinstance(member, property) or not callable(getattr(cls, name)):
            continue
        title = f"{cls.__name__}.{name}"
        if isinstance(member, staticmethod):
            setattr(cls, name, staticmethod(wrap(getattr(cls, name), title)))
        elif name == "__init__":
            made = "(self: " in (member.__doc__ or "")
            setattr(cls, name, wrapped(member, cls.__name__, member.__doc__) if made else _nobody_makes(cls))
        elif not name.startswith("__"):
            setattr(cls, name, wrap(getattr(cls, name), title))
