# SPDX-License-Identifier: BSD-3-Clause
"""Docstrings, which are plain text, as Sphinx reads them: paragraphs, and what is laid out in columns as it stands."""

import re


def escaped(line):
    """No character has a meaning but `code`."""
    parts = re.split(r"(``?[^`]+``?)", line)
    return "".join(
        f"``{p.strip('`')}``"
        if p.startswith("`") and p.endswith("`") and len(p) > 2
        else re.sub(r"([\\*_|`])", r"\\\1", p)
        for p in parts
    )


def is_layout(paragraph):
    """Lines that are indented, or hold columns."""
    return any(line.startswith(" ") or re.search(r"\S {2,}\S", line) for line in paragraph)


def process_docstring(app, what, name, obj, options, lines):
    if lines and lines[0].startswith("Alias for field number"):  # what Python says of a field without a docstring
        lines.clear()
        return
    paragraphs, current = [], []
    for line in [*lines, ""]:
        if line.strip():
            current.append(line.rstrip())
        elif current:
            paragraphs.append(current)
            current = []
    result = []
    for paragraph in paragraphs:
        if is_layout(paragraph):
            result += [".. code-block:: text", "", *["   " + line for line in paragraph], ""]
        else:
            result += [escaped(" ".join(paragraph)), ""]
    lines[:] = result


def simple(signature):
    """The types of pybind11 in words of Python."""
    text = re.sub(r"mmbrdf\._mmbrdf\.|numpy\.", "", signature)
    text = re.sub(
        r": (object|dict)(?=[,)=\s])|\bself: \w+(, )?",
        lambda m: "" if m[0].startswith(("self", ": object")) else m[0],
        text,
    )
    return re.sub(r"Optional\[(\w+)\]", r"\1 | None", text)


def process_signature(app, what, name, obj, options, signature, return_annotation):
    if signature is None:
        return None
    if return_annotation:
        return_annotation = simple(return_annotation)
        return_annotation = None if return_annotation == "object" else return_annotation
    return simple(signature), return_annotation


def skip_member(app, what, name, obj, skip, options):
    return True if name in ("annotations",) else None
