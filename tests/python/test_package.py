# SPDX-License-Identifier: BSD-3-Clause
"""The package as a whole: what it offers is typed and documented."""

import ast
import inspect
from pathlib import Path

import numpy as np
import pytest

import mmbrdf
from mmbrdf import _mmbrdf

STUB = Path(mmbrdf.__file__).parent / "_mmbrdf.pyi"


def public(names):
    return {name for name in names if not name.startswith("_")}


def stub_definitions():
    tree = ast.parse(STUB.read_text())
    return {node.name: node for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}


def test_the_stub_names_all_functions_and_classes():
    assert public(stub_definitions()) == public(vars(_mmbrdf))


def test_the_stub_names_all_methods_and_properties():
    for name, node in stub_definitions().items():
        if isinstance(node, ast.ClassDef):
            there = {member.name for member in node.body if isinstance(member, ast.FunctionDef)}
            assert public(there) == public(vars(getattr(_mmbrdf, name))), name


def test_the_stub_names_all_arguments():
    for name, node in stub_definitions().items():
        if isinstance(node, ast.FunctionDef):
            documented = getattr(_mmbrdf, name).__doc__.splitlines()[0]
            for argument in node.args.args + node.args.kwonlyargs:
                assert f"{argument.arg}: " in documented, f"{name}: {argument.arg}"


@pytest.mark.parametrize("name", sorted(public(vars(_mmbrdf))))
def test_everything_says_what_it_is(name):
    thing = getattr(_mmbrdf, name)
    text = inspect.getdoc(thing) or ""
    if not inspect.isclass(thing):
        text = "\n".join(text.splitlines()[1:])  # the first line is the signature
    assert len(text.strip()) > 15, name


def test_arrays_of_numbers_only():
    for wrong in ("532", [["a"]], [None], object()):
        with pytest.raises((TypeError, ValueError)):
            mmbrdf.depolarization(wrong)
    assert mmbrdf.depolarization(np.eye(4, dtype=int)) == 1
