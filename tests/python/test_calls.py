# SPDX-License-Identifier: BSD-3-Clause
"""What is wrong with the arguments of a call is said in one line: of which function, which argument, and what is wanted."""

import importlib
import inspect
import pickle
import re

import numpy as np
import pytest

import mmbrdf
from mmbrdf import _calls, _mmbrdf


def bound():
    """Everything of the compiled part that can be called, by the name that users call it by."""
    for name, thing in sorted(vars(_mmbrdf).items()):
        if name.startswith("_"):
            continue
        if not inspect.isclass(thing):
            yield name, thing, 0
            continue
        for member, value in sorted(vars(thing).items()):
            method = getattr(thing, member)
            if isinstance(value, property) or not callable(method):
                continue
            if member == "__init__" and "__signature__" in getattr(method, "__dict__", {}):
                yield name, thing, 0
            elif not member.startswith("_"):
                yield f"{name}.{member}", method, int(not isinstance(value, staticmethod))


CALLS = list(bound())


def parameters(name, function):
    one = function.__init__ if inspect.isclass(function) else function
    return list(inspect.signature(one).parameters.values())


def line_of(call):
    with pytest.raises(TypeError) as caught:
        call()
    text = str(caught.value)
    assert "\n" not in text and "incompatible" not in text and "Invoked with" not in text, text
    return text


@pytest.mark.parametrize("name, function, own", CALLS, ids=[name for name, _, _ in CALLS])
def test_an_argument_that_there_is_not_is_named(name, function, own):
    text = line_of(lambda: function(*[None] * own, no_such_thing=1))
    assert text.startswith(f"{name}: there is no argument no_such_thing"), text


@pytest.mark.parametrize("name, function, own", CALLS, ids=[name for name, _, _ in CALLS])
def test_arguments_that_are_missing_are_named(name, function, own):
    needed = [one.name for one in parameters(name, function) if one.default is one.empty and one.name != "self"]
    if not needed:
        return
    text = line_of(lambda: function(*[mmbrdf.material("ptfe")] * own))
    said = re.match(r"[\w.]+: (.*?) missing", text)
    assert said, text
    listed = re.split(", | and ", said.group(1))
    assert set(listed) <= set(needed) and listed, text


def test_signatures_are_those_of_help():
    assert (
        str(inspect.signature(mmbrdf.average_uncertainty)) == "(model, wavelength_nm, source, receiver, *, terms=None)"
    )
    assert str(inspect.signature(mmbrdf.Aperture.cone)) == "(theta_deg, phi_deg, half_angle_deg)"
    shown = str(inspect.signature(mmbrdf.Model.evaluate))
    assert shown.startswith("(self, wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg, *, frame='xy'")
    assert shown.endswith("uncertainty=False, terms=None, invalid='raise', as_xarray=False)")


@pytest.mark.parametrize(
    "call, line",
    [
        (lambda p: mmbrdf.fit(), "fit: data missing: expected mmbrdf.Dataset"),
        (lambda p: mmbrdf.fit(p), "fit: data: expected mmbrdf.Dataset, not Model"),
        (lambda p: mmbrdf.fit(p.blocks), "fit: data: expected mmbrdf.Dataset, not list"),
        (
            lambda p: mmbrdf.average(
                mmbrdf.fit(mmbrdf.simulate(p, 532, mmbrdf.germer2017_grid()), orders=(2, 1)), 532, 1, 2
            ),
            "average: model: expected mmbrdf.Model, not FitResult: its .model is one",
        ),
        (lambda p: p.evaluate(532, 45, 0), "Model.evaluate: theta_r_deg and phi_r_deg missing"),
        (
            lambda p: p.evaluate(532, 45, 0, 30, theta_r=1),
            "Model.evaluate: there is no argument theta_r, but theta_r_deg",
        ),
        (lambda p: p.evaluate(532, 45, 0, 30, 180, "sp"), "Model.evaluate: takes 5 arguments without a name, not 6; "),
        (lambda p: p.evaluate(532, 45, 0, 30, 180, phi_r_deg=1), "Model.evaluate: phi_r_deg is given twice"),
        (
            lambda p: p.evaluate(532, 45, 0, 30, 180, threads=1.5),
            "Model.evaluate: threads: expected a whole number, not float 1.5",
        ),
        (
            lambda p: p.evaluate(532, 45, 0, 30, 180, terms=[1], uncertainty=True),
            "Model.evaluate: terms: expected a dict {text: a number}, not list",
        ),
        (
            lambda p: p.reflectance_factor(532, 45, 0, 30, frame="sp"),
            "Model.reflectance_factor: there is no argument frame",
        ),
        (lambda p: mmbrdf.Dataset(3), "Dataset: theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg and mueller missing"),
        (lambda p: mmbrdf.Goniometer("a"), "Goniometer: seed: expected a whole number, not str 'a'"),
        (lambda p: mmbrdf.Aperture.cone(1, 2), "Aperture.cone: half_angle_deg missing: expected a number"),
        (lambda p: mmbrdf.load_model(3), "load_model: path: expected a path, not int 3"),
        (lambda p: mmbrdf.materials(1), "materials: takes no arguments without a name, not 1"),
        (lambda p: mmbrdf.Model(), "Model: functions give it, it has no constructor"),
        (lambda p: mmbrdf.Block(p, 0), "Block: functions give it, it has no constructor"),
        (lambda p: p.save(), "Model.save: path missing: expected a path"),
        (lambda p: mmbrdf.load(), "load: path missing: expected a path"),
        (lambda p: mmbrdf.load(3), "load: path: expected a path, not int 3"),
        (lambda p: mmbrdf.report(p), "report: data and path missing"),
        (lambda p: mmbrdf.report(p, None, 5), "report: path: expected a path, not int 5"),
        (lambda p: mmbrdf.report(p, None, "r.md", theta=45), "report: there is no argument theta, but theta_i_deg"),
        (lambda p: mmbrdf.report(p, None, "r.md", name=5), "report: name: expected text, not int 5"),
        (lambda p: mmbrdf.report(p, None, "r.md", model_file=5), "report: model_file: expected a path, not int 5"),
        (lambda p: mmbrdf.plot.hemisphere(p), "plot.hemisphere: wavelength_nm and theta_i_deg missing"),
        (
            lambda p: mmbrdf.plot.reflectance_against_angle(p, 532, theta_i_deg=45),
            "plot.reflectance_against_angle: theta_i_deg: expected a sequence, not int 45",
        ),
        (lambda p: mmbrdf.images.reduce(), "images.reduce: stack and instrument missing"),
        (lambda p: mmbrdf.images.PixelFit(532), "PixelFit: geometry missing: expected a sequence"),
        (lambda p: p.summary(1), "Model.summary: takes no arguments without a name, not 1"),
        (
            lambda p: mmbrdf.fit(mmbrdf.simulate(p, 532, mmbrdf.germer2017_grid()), "isotropic", 7),
            "fit: orders: expected a tuple (a whole number, a whole number), not int 7",
        ),
        (
            lambda p: mmbrdf.reduce("raw.csv", 5, solid_angle=1e-4),
            "reduce: instrument: expected mmbrdf.Calibration or mmbrdf.Polarimeter, not int 5",
        ),
    ],
)
def test_what_is_wrong_is_one_line(call, line, ptfe):
    assert line_of(lambda: call(ptfe)).startswith(line)


def of_python():
    """Functions and methods that are written in Python, by the name that users call them by."""
    distributed = importlib.import_module("mmbrdf.distributed")
    modules = {"images.": mmbrdf.images, "plot.": mmbrdf.plot, "distributed.": distributed}
    named = [
        (f"{prefix}{name}", getattr(module, name)) for prefix, module in modules.items() for name in module.__all__
    ]
    named += [(name, getattr(mmbrdf, name)) for name in ("load", "report", "py6s_surface", "pythonic_disort_modes")]
    for name, thing in named:
        if not inspect.isclass(thing):
            if callable(thing):
                yield name, thing, 0
        elif not issubclass(thing, tuple):
            own = name.rpartition(".")[2]
            yield own, thing, 0
            for member, value in vars(thing).items():
                if not member.startswith("_") and not isinstance(value, property):
                    yield f"{own}.{member}", getattr(thing, member), int(not isinstance(value, staticmethod))


OF_PYTHON = sorted(of_python(), key=lambda one: one[0])


@pytest.mark.parametrize("name, function, own", OF_PYTHON, ids=[name for name, _, _ in OF_PYTHON])
def test_functions_of_python_say_it_as_those_of_the_library_do(name, function, own):
    if "read" not in inspect.signature(function).parameters:  # whose other options are those of read_samples
        line = line_of(lambda: function(*[None] * own, no_such_thing=1))
        assert line.startswith(f"{name}: there is no argument no_such_thing"), line
    needed = [one.name for one in parameters(name, function) if one.default is one.empty and one.name != "self"]
    needed = [one for one in needed if one != "read"]
    if needed:
        line = line_of(lambda: function(*[None] * own))
        said = re.match(r"[\w.]+: (.*?) missing", line)
        assert line.startswith(f"{name}: ") and said, line
        assert re.split(", | and ", said.group(1)) == needed
    line = line_of(lambda: function(*[None] * 40))
    assert re.match(rf"{re.escape(name)}: takes (no|\d+) arguments? without a name, not", line), line
    pickled = pickle.loads(pickle.dumps(function))
    assert pickled is function or own


WRONG = {
    "str": 5,
    "bool": "yes",
    "int": 1.5,
    "float": "1",
    "Model": 5,
    "Dataset": 5,
    "Sequence": 5,
    "Mapping": 5,
    "dict": 5,
    "Callable": 5,
}
WRONG |= {"os.PathLike": 5, "Calibration": 5, "Axes": 5, "Figure": 5, "Iterable": 5, "Polarimeter": 5}


@pytest.mark.parametrize("name, function, own", OF_PYTHON, ids=[name for name, _, _ in OF_PYTHON])
def test_functions_of_python_name_the_argument_that_is_of_another_kind(name, function, own):
    """Whatever else is wrong with the call: the others are missing."""
    for one in parameters(name, function):
        kinds = [kind.strip().partition("[")[0] for kind in str(one.annotation).split("|")]
        if not kinds or any(kind not in WRONG and kind != "None" for kind in kinds):
            continue  # the function looks itself
        wrong = next(WRONG[kind] for kind in kinds if kind != "None")
        if any(_calls.fits(wrong, _calls._wanted(kind)) for kind in kinds):
            continue
        wrong_call = list(_calls.faults(_calls.arguments_in_python(function), [None] * own, {one.name: wrong}))
        assert any(line.startswith(f"{one.name}: expected ") for line in wrong_call), (name, one)


def test_right_calls_are_not_refused():
    """Every type that the documentation of the compiled part names is known: by its words, or let through."""
    for _, function, _ in CALLS:
        text = (function.__init__ if inspect.isclass(function) else function).__doc__ or ""
        for signature in _calls.signatures(text):
            for one in _calls.arguments_of(signature):
                words = _calls.in_words(one.wanted)
                assert words == "object" or not re.search(r"[\[\]]|Optional|Union|pybind", words), (signature, words)
                if one.default is not None:
                    assert _calls.fits(_calls._value(one.default), one.wanted, one.default), (signature, one)


def test_numpys_numbers_are_numbers(ptfe):
    f = ptfe.evaluate(np.float32(532), np.int8(45), 0, 30, 180, threads=np.int64(1))
    np.testing.assert_array_equal(f, ptfe.evaluate(532, 45, 0, 30, 180))
    assert mmbrdf.Aperture.cone(np.float64(3), 0, np.int32(2)) is not None


def test_warnings_are_of_the_line_of_the_user(ptfe, tmp_path):
    """However deep within the package they come up."""
    calls = [
        lambda: ptfe.evaluate(532, 89, 0, 30, 180),
        lambda: ptfe.evaluate(532, 89, 0, [30, np.nan], 180, uncertainty=True, invalid="nan"),
        lambda: ptfe.reflectance_factor(532, 89, 0, 30, 180),
        lambda: mmbrdf.directional_hemispherical_reflectance(ptfe, 532, 89),
        lambda: mmbrdf.py6s_surface(ptfe, 532, sun_deg=30, view_deg=88, azimuth_deg=90),
        lambda: mmbrdf.pythonic_disort_modes(ptfe, 532, streams=6),
        lambda: mmbrdf.pythonic_disort_modes(ptfe, 2000, streams=32),
        lambda: mmbrdf.certified(ptfe, 532, 0.5, 0.01),
    ]
    for call in calls:
        with pytest.warns(UserWarning) as caught:
            call()
        assert {one.filename for one in caught} == {__file__}, call
        lines = range(call.__code__.co_firstlineno, call.__code__.co_firstlineno + 1)
        assert {one.lineno for one in caught} <= set(lines)
