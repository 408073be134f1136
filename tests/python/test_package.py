# SPDX-License-Identifier: BSD-3-Clause
"""The package as a whole: what it offers is typed and documented."""

import ast
import inspect
from pathlib import Path

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
        if isinstance(node, ast.ClassDef) and not name.startswith("_"):
            there = {member.name for member in node.body if isinstance(member, ast.FunctionDef)}
            assert public(there) == public(vars(getattr(_mmbrdf, name))), name


def test_the_stub_names_everything_once():
    """But for overloads; of two others a type checker takes the last."""
    tree = ast.parse(STUB.read_text())
    for scope in [tree, *(node for node in tree.body if isinstance(node, ast.ClassDef))]:
        defined = [node for node in scope.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))]
        alone = [n.name for n in defined if "overload" not in {getattr(one, "id", "") for one in n.decorator_list}]
        twice = {name for name in alone if alone.count(name) > 1}
        assert not twice, f"{getattr(scope, 'name', STUB.name)}: {sorted(twice)}"


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


def test_nothing_is_no_object_of_the_library(tmp_path):
    """None in the place of an object is a TypeError, and not the end of the interpreter."""
    (tmp_path / "raw.csv").write_text("")
    for call in (
        lambda: mmbrdf.reduce(tmp_path / "raw.csv", None, solid_angle=1e-4),
        lambda: mmbrdf.fit(None),
        lambda: mmbrdf.residuals(None, None),
        lambda: mmbrdf.average(None, 532, None, None),
        lambda: mmbrdf.Model.blocks.fget(None),
        lambda: mmbrdf.Model.evaluate(None, 532, 0, 0, 0, 0),
        lambda: mmbrdf.Dataset.normalized.fget(None),
        lambda: mmbrdf.FitResult.residuals.fget(None),
        lambda: mmbrdf.Calibration.covariance.fget(None),
    ):
        with pytest.raises((TypeError, RuntimeError)):
            call()
