# SPDX-License-Identifier: BSD-3-Clause
"""Finite numbers go in, finite numbers come out, or a ValueError; nan and inf only where the documentation has the word."""

import inspect
import math
import re
import warnings

import numpy as np
import pytest

import mmbrdf

pytestmark = pytest.mark.filterwarnings("ignore")
CALLS = 25  # of each function
SLOW = {"compare": 6, "projected_on_isotropic": 6, "optimal_angles": 4, "bihemispherical_uncertainty": 8}  # fewer

# What reads or writes files, or takes time: other tests have them.
OTHERS = """load load_instrument load_model read_foreign read_samples calibrate reduce report select subsets plan choose fit symmetry_tests report_json
    model_diagnostics sample_diagnostics outliers materials quantities material average average_uncertainty""".split()


def size(rng):
    """A number of any magnitude."""
    return rng.choice([0, 1, -1, 1e-300, 1e300, 10.0 ** rng.uniform(-12, 12), rng.normal(), -rng.random()])


def matrix(rng, physical=0.5):
    if rng.random() < physical:
        m = np.diag([1, *rng.uniform(-0.5, 0.5, 3)]) + np.pad(rng.uniform(-0.05, 0.05, (3, 3)), ((1, 0), (1, 0)))
        return m * 10.0 ** rng.uniform(-300, 300)
    return np.array([size(rng) for _ in range(16)]).reshape(4, 4)


def light(rng):
    s = rng.normal(size=3)
    return np.array([1, *(s / np.linalg.norm(s) * rng.choice([0, 0.3, 1 - 1e-15]))]) * 10.0 ** rng.uniform(-200, 200)


def angle(rng, largest):
    return float(rng.choice([0, largest, 1e-300, 1e-9, largest - 1e-9, rng.uniform(0, largest)]))


def covariance(rng):
    a = rng.normal(size=(16, 16)) * 10.0 ** rng.uniform(-100, 100)
    return a @ a.T


@pytest.fixture(scope="module")
def models(anisotropic, samples):
    huge = mmbrdf.Model.from_json(mmbrdf.material("ptfe-532").to_json().replace("0.98", "9e300"))
    least = mmbrdf.fit(samples, uncertainty="noise").model
    return [
        mmbrdf.material("ptfe"),
        mmbrdf.material("ptfe-351"),
        anisotropic,
        least,
        mmbrdf.in_published_form(least),
        huge,
    ]


@pytest.fixture(scope="module")
def make(models, samples):
    """Arguments by their names."""
    few = mmbrdf.simulate(models[0], 532, mmbrdf.random_geometries(12, 1), speckle=0.1, seed=1)
    frames, conventions = ["xy", "sp", "scattering_plane"], [
        "s_first_left",
        "s_first_right",
        "p_first_left",
        "p_first_right",
    ]
    one_of = lambda values: lambda rng: values[rng.integers(len(values))]  # noqa: E731
    polar, azimuth = lambda rng: angle(rng, 90), lambda rng: float(
        rng.choice([0, -1e5, 1e9, rng.uniform(-720, 720)])
    )  # noqa: E731
    return {
        **dict.fromkeys(["mueller", "mueller_sp"], matrix),
        **dict.fromkeys(["stokes", "analyzer"], light),
        **dict.fromkeys(["theta_i_deg", "theta_r_deg", "theta_max_deg"], polar),
        **dict.fromkeys(["phi_i_deg", "phi_r_deg", "azimuth_deg", "angle_deg"], azimuth),
        "model": one_of(models),
        **dict.fromkeys(["sun_deg", "view_deg"], polar),
        "streams": lambda rng: int(rng.integers(1, 12)),
        "wavelength_nm": lambda rng: float(rng.choice([532, 351, 1064, 1e-3, 1e7, rng.uniform(300, 2000)])),
        "from_frame": one_of(frames),
        "to_frame": one_of(frames),
        "from_convention": one_of(conventions),
        "to_convention": one_of(conventions),
        "gradient": matrix,
        "covariance": covariance,
        "f11": size,
        "retardance_deg": azimuth,
        "azimuths_deg": lambda rng: rng.uniform(-200, 200, 6),
        "dials_deg": lambda rng: rng.uniform(-200, 200, (6, 2)),
        "ratio": lambda rng: float(rng.choice([5, 2.5, -1])),
        "step_deg": lambda rng: float(rng.uniform(1, 20)),
        "frames": lambda rng: int(rng.integers(1, 60)),
        "generator": lambda rng: list(rng.choice(["s", "p", "+45", "-45", "L", "R", "u"], 4)),
        "extinction": lambda rng: float(rng.choice([0, 1, 1e-300, rng.random()])),
        "states": lambda rng: int(rng.integers(4, 8)),
        "film": lambda rng: (
            complex(rng.uniform(1, 3), rng.choice([0, 1])),
            angle(rng, 1e4),
            complex(rng.uniform(1, 5), rng.random()),
        ),
        "geometry": lambda rng: mmbrdf.random_geometries(3, int(rng.integers(100)), angle(rng, 89) + 0.5),
        "count": lambda rng: int(rng.integers(1, 9)),
        "seed": lambda rng: int(rng.integers(1, 9)),
        "data": lambda rng: few,
        "other": one_of([few, *models]),
        "parts": lambda rng: {"a": abs(size(rng)), "b": abs(size(rng))},
        "reflectance": lambda rng: float(rng.choice([0.9, 1e-3, 0.99])),
        "u": lambda rng: float(rng.choice([0, 1e-3])),
        "name": lambda rng: "it",
    }


def numbers(value):
    """All that are in a result."""
    if value is None or isinstance(value, (str, bool, int)):
        return
    if isinstance(value, dict):
        value = tuple(value.values())
    if isinstance(value, (tuple, list)):
        for one in value:
            yield from numbers(one)
    elif isinstance(value, mmbrdf.Model):
        yield from numbers([block.coefficients for block in value.blocks])
    elif isinstance(value, mmbrdf.Dataset):
        yield from numbers([value.f11, value.normalized])
    elif isinstance(value, (float, complex, np.ndarray, np.generic)):
        yield from np.atleast_1d(np.asarray(value)).ravel()


def functions():
    for name, one in sorted(vars(mmbrdf).items()):
        if not name.startswith("_") and not inspect.isclass(one) and callable(one) and name not in OTHERS:
            yield name, one


def methods():
    for name in (
        "analyze",
        "covariance",
        "evaluate",
        "evaluate_uncertainty",
        "predict_readings",
        "reflectance_factor",
        "reflectance_factor_uncertainty",
    ):
        yield f"Model.{name}", lambda model, *arguments, name=name: getattr(model, name)(*arguments)


# Of those for which the name of an argument does not say what it is.
PECULIAR = {
    "condition_number": lambda rng: [np.column_stack([np.ones(6), rng.uniform(-0.5, 0.5, (6, 3))]) * abs(size(rng))],
    "retardance": lambda rng: [mmbrdf.retarder(rng.uniform(0, 180), rng.uniform(0, 180))],
}


def required(name, one):
    """The names of the arguments that it must have, and of the angles and the light that it may have."""
    if name.startswith("Model."):
        return ["model", "wavelength_nm", "theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg"]
    if inspect.isfunction(one) and not hasattr(one, "__wrapped__"):  # of Python, which says what it takes
        all_of_them = inspect.signature(one).parameters.values()
        return [a.name for a in all_of_them if a.default is a.empty or a.name == "wavelength_nm"]
    arguments = re.search(r"\((.*)\)", one.__doc__.split("\n")[0]).group(1)
    arguments = re.sub(r"= \([^)]*\)", "=", arguments)
    arguments = re.sub(r"\[[^\]]*(\[[^\]]*\][^\]]*)*\]", "", arguments).split("*, ")[0].split(", ")
    return [
        a.split(":")[0]
        for a in arguments
        if a and ("=" not in a or a.split(":")[0] in ("wavelength_nm", "theta_i_deg", "theta_r_deg", "stokes"))
    ]


@pytest.mark.parametrize("name, one", [*functions(), *methods()], ids=lambda x: x if isinstance(x, str) else "")
def test_finite_numbers_give_finite_numbers(name, one, make):
    documented = (getattr(mmbrdf.Model, name[6:]) if name.startswith("Model.") else one).__doc__
    rng = np.random.default_rng(len(name))
    answered = 0
    for _ in range(SLOW.get(name, CALLS)):
        names = [] if name in PECULIAR else required(name, one)
        arguments = PECULIAR[name](rng) if name in PECULIAR else [make[argument](rng) for argument in names]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                result = (
                    one(**dict(zip(names, arguments, strict=True))) if names and "." not in name else one(*arguments)
                )
            except ValueError:
                continue
        answered += 1
        for number in numbers(result):
            bad = "nan" if np.isnan(number) else "inf" if np.isinf(number) else ""
            assert not bad or re.search(rf"\b{bad}\b", documented), (bad, arguments)
    assert answered > 0


def test_moments_in_azimuth_are_finite(models):
    rng = np.random.default_rng(1)
    answered = 0
    for model in models:
        for nm in (532, 1e-3, 1e7):
            mu = [0.0, 1e-300, 1.0, *rng.random(2)]
            try:
                result = model.fourier_moments(nm, mu, mu)
            except ValueError:
                continue
            answered += 1
            assert all(np.isfinite(number) for number in numbers(result))
    assert answered > 8
