# SPDX-License-Identifier: BSD-3-Clause
"""Every public type survives pickle and copy: a process can send all that the package gives to another."""

import copy
import inspect
import pickle
import re
import warnings

import numpy as np
import pytest

import mmbrdf

TYPES = {name: one for name, one in sorted(vars(mmbrdf).items()) if inspect.isclass(one) and not name.startswith("_")}


def accumulator(data):
    result = mmbrdf.FitAccumulator(orders=(3, 2))
    result.add(data)
    return result


def sample_accumulator(data):
    result = mmbrdf.SampleFitAccumulator(orders=(3, 2), weights="none")
    result.add(data)
    return result


@pytest.fixture(scope="module")
def examples(ptfe, samples, tmp_path_factory):
    """One of each type; of tuples, those that a call gives are enough."""
    folder = tmp_path_factory.mktemp("pickles")
    few = samples[::4]
    goniometer = mmbrdf.Goniometer(3, dials_deg=mmbrdf.dial_angles(5, 6, 30), retardance_deg=127)
    standing = mmbrdf.Goniometer(1)
    standing.write_references(folder / "references.csv", 532)
    standing.write_raw(folder / "raw.csv", ptfe, 532, mmbrdf.in_plane(45, [0, 30]))
    instrument = mmbrdf.calibrate(folder / "references.csv", film=standing.film)
    fit = mmbrdf.fit(few, orders=(3, 2))
    matrix = ptfe.evaluate(532, 45, 0, 30, 180, frame="sp")
    return [
        ptfe,
        *ptfe.blocks[:1],
        few,
        mmbrdf.reduce(folder / "raw.csv", instrument, solid_angle=standing.solid_angle),
        fit,
        accumulator(few),
        sample_accumulator(few),
        mmbrdf.Aperture.cone(30, 10, 5).without(mmbrdf.Aperture.cone(30, 10, 1)),
        mmbrdf.ideal_states(["s", "p", "+45", "L"]),
        mmbrdf.Polarimeter(np.eye(4) + [1, 0, 0, 0], np.eye(4) + [1, 0, 0, 0], [(0, 1), (2, 3)]),
        instrument,
        *instrument.references[:1],
        goniometer,
        standing,
        mmbrdf.DirectionSampler(ptfe, 532),
        ptfe.evaluate(532, 45, 0, [0, 30], 180, uncertainty=True),
        mmbrdf.in_plane(45, [0, 30]),
        ptfe.analyze(532, 45, 0, [0, 30], 180)["f_ss"],
        mmbrdf.budget({"a": 0.1}),
        mmbrdf.Outside.THETA_I | mmbrdf.Outside.WAVELENGTH,
        mmbrdf.DirectionSampler(ptfe, 532).sample(30, 0, [0.1, 0.7], [0.2, 0.3]),
        ptfe.fourier_moments(532, [0.5], [0.3, 0.7]),
        mmbrdf.polarized_curve(ptfe, 532, mmbrdf.in_plane(45, [0, 30])),
        mmbrdf.quantities()[0],
        mmbrdf.cloude_decomposition(matrix),
        mmbrdf.lu_chipman(matrix),
        mmbrdf.symmetric_decomposition(matrix),
        mmbrdf.select(few, orders_f11=(2, 3), orders_other=(1, 2)),
        mmbrdf.inspect(few),
        mmbrdf.subsets(few, orders=(3, 2)),
        mmbrdf.plan({"a": mmbrdf.in_plane(45, [0, 30])}),
        mmbrdf.symmetry_tests(few, (3, 2)),
        mmbrdf.sample_diagnostics(fit, few),
        mmbrdf.mirror_pairs(samples),
        mmbrdf.model_diagnostics(ptfe, 532),
        mmbrdf.compare(ptfe, fit.model),
        mmbrdf.ExtrapolationWarning("beyond"),
        mmbrdf.InstrumentWarning("doubtful"),
    ]


# Tuples of text and numbers that the calls above need not give.
PLAIN = {
    "Finding": mmbrdf.Finding("fill values", "f11 = -999", "leave out", (3,)),
    "Outlier": mmbrdf.Outlier(3, "22", 6.1),
    "Untested": mmbrdf.Untested("cosine", "few samples"),
    "HeldOut": mmbrdf.HeldOut(None, None, None, "all"),
}


def within(thing):
    """It, and what it holds."""
    yield thing
    if isinstance(thing, dict):
        thing = tuple(thing.values())
    if isinstance(thing, (tuple, list)):
        for one in thing:
            yield from within(one)


def shown(thing):
    """All that can be seen of an object: its text, its properties, its numbers."""
    if isinstance(thing, dict):
        return {name: shown(one) for name, one in thing.items()}
    if isinstance(thing, (tuple, list)):
        return [type(thing).__name__, *(shown(one) for one in thing)]
    if isinstance(thing, (np.ndarray, np.generic)):
        return np.asarray(thing).shape, np.asarray(thing).tobytes()
    if type(thing).__module__.startswith("mmbrdf._mmbrdf"):
        names = [name for name, one in vars(type(thing)).items() if isinstance(one, property)]
        more = [thing.to_json()] if isinstance(thing, mmbrdf.Model) else []
        more += [thing.state().tobytes()] if hasattr(thing, "state") else []
        return [re.sub(" at 0x.*", "", repr(thing)), *more, *(shown(getattr(thing, name)) for name in names)]
    return f"{thing:.15g}" if isinstance(thing, float) else repr(thing)  # what is kept in degrees loses its last bit


def copies(thing):
    yield from (pickle.loads(pickle.dumps(thing, protocol)) for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1))
    yield copy.copy(thing)
    yield copy.deepcopy(thing)


@pytest.mark.parametrize("name", TYPES)
def test_every_public_type_survives_pickle_and_copy(name, examples):
    found = [one for one in within([*examples, *PLAIN.values()]) if type(one) is TYPES[name]]
    assert found, f"{name}: the test knows none; a new type needs an example here"
    for one in found[:2]:
        for same in copies(one):
            assert type(same) is type(one)
            assert shown(same) == shown(one)


def test_copies_do_the_same(examples, ptfe, tmp_path):
    """What is not seen of an object: what it gives."""
    of = {type(one): one for one in examples}
    goniometer, sampler = of[mmbrdf.Goniometer], of[mmbrdf.DirectionSampler]
    for number, one in enumerate([goniometer, *copies(goniometer)]):
        one.write_raw(tmp_path / f"{number}.csv", ptfe, 532, mmbrdf.in_plane(45, [0, 30]), seed=2)
    files = list(tmp_path.iterdir())
    assert len(files) > 3 and len({path.read_bytes() for path in files}) == 1
    for one in copies(sampler):
        np.testing.assert_array_equal(one.sample(30, 0, 0.3, 0.6), sampler.sample(30, 0, 0.3, 0.6))


@pytest.mark.parametrize(
    "function", [mmbrdf.fit, mmbrdf.depolarization, mmbrdf.Model.evaluate], ids=lambda f: f.__name__
)
def test_functions_are_sent_by_their_name(function):
    assert pickle.loads(pickle.dumps(function)) is function


def test_a_pickle_of_something_else_is_refused(samples):
    text = pickle.dumps(samples[:1])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(ValueError, match="not pickled by this version"):
            pickle.loads(text.replace(b"mmbrdf.Dataset 1", b"mmbrdf.Dataset 9"))
