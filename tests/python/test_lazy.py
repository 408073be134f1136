# SPDX-License-Identifier: BSD-3-Clause
"""Dask arrays and DataArrays in, the same out: lazily, with names, and with the bits of the eager call."""

import pickle
import re

import numpy as np
import pytest

import mmbrdf

pytest.importorskip("dask.array", reason="no Dask: ./dev packages clusters")
xarray = pytest.importorskip("xarray", reason="no xarray: ./dev packages python")
import dask.array as da  # noqa: E402

THETA_R = np.linspace(-60, 60, 35).reshape(5, 7)
QUESTION = (532, 45.0, 0.0, THETA_R, np.full((5, 7), 30.0))


def lazy_question():
    return (532, 45.0, 0.0, da.from_array(THETA_R, chunks=(2, 3)), da.from_array(QUESTION[4], chunks=(5, 2)))


def same(result, expected):
    assert isinstance(result, da.Array)
    computed = result.compute()
    np.testing.assert_array_equal(computed, expected)
    assert computed.dtype == np.asarray(expected).dtype == result.dtype
    assert result.shape == np.shape(expected)


@pytest.mark.parametrize(
    "method, options",
    [
        ("evaluate", {"frame": "sp"}),
        ("evaluate_uncertainty", {"terms": {"scale": 0.003}}),
        ("covariance", {}),
        ("outside", {}),
        ("estimable", {}),
    ],
)
def test_a_model_is_asked_in_chunks_with_the_bits_of_one_call(ptfe, method, options):
    same(getattr(ptfe, method)(*lazy_question(), **options), getattr(ptfe, method)(*QUESTION, **options))


def test_arguments_by_name_and_many_wavelengths_are_chunks_too(ptfe):
    nm = np.array([351.0, 532.0, 633.0])
    result = ptfe.evaluate(
        wavelength_nm=da.from_array(nm, chunks=2), theta_i_deg=45, phi_i_deg=0, theta_r_deg=30, phi_r_deg=180
    )
    same(result, ptfe.evaluate(nm, 45, 0, 30, 180))


def test_draws_are_the_first_axis(ptfe):
    same(ptfe.evaluate_draws(3, 7, *lazy_question()), ptfe.evaluate_draws(3, 7, *QUESTION))


def test_an_analysis_has_the_numbers_of_the_eager_one(samples):
    small = mmbrdf.fit(samples, orders=(2, 1), uncertainty="noise").model
    lazy = small.analyze(*lazy_question(), terms={"scale": 0.003}, stokes=[1, 0, 0, -1], draws=20, seed=2)
    eager = small.analyze(*QUESTION, terms={"scale": 0.003}, stokes=[1, 0, 0, -1], draws=20, seed=2)
    assert list(lazy) == list(eager)
    for name in ("depolarization", "f_ss", "degree_of_polarization"):
        for field in ("value", "u", "low", "high"):
            same(getattr(lazy[name], field), getattr(eager[name], field))
        assert list(lazy[name].parts) == list(eager[name].parts)
        same(lazy[name].parts["scale"], eager[name].parts["scale"])


def test_every_function_of_matrices_has_the_bits_of_the_eager_call(random_matrices):
    chunked = da.from_array(random_matrices, chunks=(2, 3, 4, 4))
    stokes = np.array([1.0, 0.2, 0.1, -0.3])
    for q in mmbrdf.quantities():
        function, more = getattr(mmbrdf, q.name), (stokes,) if q.takes_light else ()
        same(function(chunked, *more, invalid="nan"), function(random_matrices, *more, invalid="nan"))
    for name in ("normalized", "exchanged", "mirrored", "nearest_realizable", "realizable", "coherency"):
        same(getattr(mmbrdf, name)(chunked), getattr(mmbrdf, name)(random_matrices))
    for name in ("lu_chipman", "cloude_decomposition", "symmetric_decomposition", "co_and_cross_polarized"):
        lazy, eager = getattr(mmbrdf, name)(chunked), getattr(mmbrdf, name)(random_matrices)
        assert type(lazy) is type(eager)
        for one, other in zip(lazy, eager):
            same(one, other)
    turned = mmbrdf.change_frame(chunked, 45, 0, da.from_array(THETA_R, chunks=2), 30.0, "xy", "sp")
    same(turned, mmbrdf.change_frame(random_matrices, 45, 0, THETA_R, 30.0, "xy", "sp"))


def test_reflectances_and_drawn_directions_are_lazy(ptfe):
    theta = np.linspace(0, 70, 6)
    chunks = da.from_array(theta, chunks=4)
    same(
        mmbrdf.directional_hemispherical_reflectance(ptfe, 532, chunks, 0),
        mmbrdf.directional_hemispherical_reflectance(ptfe, 532, theta, 0),
    )
    sampler = mmbrdf.DirectionSampler(ptfe, 532)
    for one, other in zip(sampler.sample(chunks, 0, 0.3, 0.7), sampler.sample(theta, 0, 0.3, 0.7)):
        same(one, other)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_readings_are_reduced_in_chunks_and_keep_their_precision(random_matrices, dtype):
    instrument = mmbrdf.ideal_polarimeter(131.81, [-51.69, -15.12, 15.12, 51.69])
    readings = instrument.readings(random_matrices).astype(dtype)
    chunked = da.from_array(readings, chunks=(2, 3, 4, 4))
    same(instrument.reduce(chunked), instrument.reduce(readings))
    same(instrument.readings(da.from_array(random_matrices, chunks=(3, 7, 4, 4))), instrument.readings(random_matrices))


def test_names_and_attributes_are_kept_and_units_are_those_of_the_result(random_matrices):
    labels = {"y": np.arange(5), "x": np.arange(7)}
    image = xarray.DataArray(
        random_matrices, labels, ["y", "x", "row", "column"], "brdf", {"units": "sr-1", "frame": "xy", "sample": "A"}
    )
    result = mmbrdf.depolarization(image)
    assert (result.name, result.dims) == ("depolarization", ("y", "x"))
    assert result.attrs["sample"] == "A" and "units" not in result.attrs
    np.testing.assert_array_equal(result.values, mmbrdf.depolarization(random_matrices))
    assert mmbrdf.f_ss(image).attrs["units"] == "sr-1"
    lazy = mmbrdf.lu_chipman(image.transpose("row", "column", "x", "y").chunk({"x": 2}))
    assert lazy.depolarizer.dims == ("x", "y", "row", "column") and lazy.depolarizer.chunks is not None
    np.testing.assert_array_equal(lazy.retarder.transpose("y", ...).values, mmbrdf.lu_chipman(random_matrices).retarder)
    turned = mmbrdf.change_frame(image, 45, 0, xarray.DataArray(np.full(7, 30.0), dims="x"), 0, "xy", "sp")
    assert turned.attrs["frame"] == "sp" and turned.attrs["units"] == "sr-1"


def test_a_model_broadcasts_named_angles_by_their_names(ptfe):
    theta_i = xarray.DataArray([10.0, 50.0], dims="theta_i", coords={"theta_i": [10.0, 50.0]})
    theta_r = xarray.DataArray(da.from_array(np.linspace(0, 60, 9), chunks=4), dims="theta_r")
    result = ptfe.evaluate(532, theta_i, 0, theta_r, 180)
    assert result.dims == ("theta_i", "theta_r", "row", "column") and result.name == "brdf"
    assert result.attrs["units"] == "sr-1" and result.attrs["frame"] == "xy"
    assert list(result.row.values) == [1, 2, 3, 4]
    np.testing.assert_array_equal(result.values, ptfe.evaluate(532, [[10], [50]], 0, np.linspace(0, 60, 9), 180))


def test_what_was_evaluated_goes_through_a_file_in_chunks(ptfe, tmp_path):
    theta_r = xarray.DataArray(np.linspace(0, 60, 9), dims="theta_r", name="theta_r_deg").chunk({"theta_r": 4})
    ptfe.evaluate(532, 45, 0, theta_r, 180).to_dataset().to_netcdf(tmp_path / "brdf.nc")
    with xarray.open_dataset(tmp_path / "brdf.nc", chunks={"theta_r": 5}) as read:
        result = mmbrdf.depolarization(read.brdf)
        assert result.chunks == ((5, 4),)
        expected = mmbrdf.depolarization(ptfe.evaluate(532, 45, 0, np.linspace(0, 60, 9), 180))
        np.testing.assert_array_equal(result.values, expected)


def test_chunks_that_cut_a_matrix_are_refused_with_the_call_that_joins_them(random_matrices):
    cut = da.from_array(random_matrices, chunks=(5, 7, 2, 4))
    with pytest.raises(
        ValueError, match=r"mueller: chunks \(2, 2\) cut the axis 'row': .*mueller.rechunk\(\{-2: -1, -1: -1\}\)"
    ):
        mmbrdf.depolarization(cut)
    named = xarray.DataArray(cut, dims=["y", "x", "row", "column"])
    with pytest.raises(ValueError, match=r"mueller.chunk\(\{'row': -1, 'column': -1\}\)"):
        mmbrdf.depolarization(named)
    instrument = mmbrdf.ideal_states(["s", "p", "+45", "L"])
    frames = xarray.DataArray(da.ones((6, 4, 4), chunks=(6, 4, 2)), dims=["y", "analyzer", "generator"])
    with pytest.raises(ValueError, match=r"readings: chunks \(2, 2\) cut the axis 'generator'"):
        instrument.reduce(frames)


def test_shapes_and_names_that_do_not_fit_are_named(ptfe, random_matrices):
    with pytest.raises(ValueError, match="mueller: axis 'column' has 3 places, expected 4"):
        mmbrdf.depolarization(xarray.DataArray(random_matrices[..., :3], dims=["y", "x", "row", "column"]))
    with pytest.raises(TypeError, match="phi_r_deg: an array without names beside an xarray.DataArray"):
        ptfe.evaluate(532, 45, 0, xarray.DataArray([0.0, 30.0], dims="theta_r"), [0.0, 180.0])
    with pytest.raises(TypeError, match="out is not for Dask arrays"):
        ptfe.evaluate(532, 45, 0, da.zeros(3), 0, out=np.zeros((3, 4, 4)))
    with pytest.raises(ValueError, match=r"readings: last axes \(3, 4\), the instrument has \(4, 4\)"):
        mmbrdf.ideal_states(["s", "p", "+45", "L"]).reduce(da.zeros((2, 3, 4)))
    with pytest.raises(TypeError, match="^Model.evaluate: theta_r_deg is given twice$"):
        ptfe.evaluate(532, 45, 0, da.zeros(3), 0, theta_r_deg=0)


def test_what_a_chunk_needs_can_be_sent_to_other_processes(ptfe, random_matrices):
    instrument = mmbrdf.rotating_retarders(mmbrdf.dial_angles(5, 6.0, 61))
    copy = pickle.loads(pickle.dumps(instrument))
    np.testing.assert_array_equal(copy.pairs, instrument.pairs)
    np.testing.assert_array_equal(copy.readings(random_matrices), instrument.readings(random_matrices))
    sampler = pickle.loads(pickle.dumps(mmbrdf.DirectionSampler(ptfe, 532)))
    assert sampler.sample(45, 0, 0.3, 0.7) == mmbrdf.DirectionSampler(ptfe, 532).sample(45, 0, 0.3, 0.7)
    question = lazy_question()
    lazily = pickle.loads(pickle.dumps(ptfe.evaluate(*question)))
    same(lazily, ptfe.evaluate(*QUESTION))


def test_warnings_of_extrapolation_come_when_it_is_computed(ptfe):
    lazy = ptfe.evaluate(532, 45, 0, da.from_array(np.array([30.0, 89.0]), chunks=1), 180)
    with pytest.warns(mmbrdf.ExtrapolationWarning):
        lazy.compute(scheduler="synchronous")


def test_warnings_are_those_of_the_line_that_asked(ptfe):
    """So that a filter for one warning of each place does not take all places for one."""
    with pytest.warns(mmbrdf.ExtrapolationWarning) as warned:
        ptfe.evaluate(532, 45, 0, 89.5, 180)
        ptfe.evaluate(532, 45, 0, 89.5, 180)
    assert [one.filename for one in warned] == [__file__] * 2
    assert warned[1].lineno == warned[0].lineno + 1


def test_value_u_and_validity_come_together_and_stay_lazy(ptfe):
    theta = np.array([0.0, 30.0, np.nan, 85.0])
    more = {"uncertainty": True, "terms": {"scale": 0.003}, "invalid": "nan"}
    for ask in (ptfe.evaluate, ptfe.reflectance_factor):
        eager = ask(532, 45, 0, theta, 180, **more)
        lazy = ask(532, 45, 0, da.from_array(theta, chunks=2), 180, **more)
        named = ask(532, 45, 0, xarray.DataArray(theta, dims="view").chunk({"view": 2}), 180, **more)
        for one, chunked, labelled in zip(eager, lazy, named):
            assert isinstance(chunked, da.Array) and labelled.chunks is not None and labelled.dims[0] == "view"
            np.testing.assert_array_equal(chunked.compute(), one)
            np.testing.assert_array_equal(labelled.values, one)
    with pytest.raises(TypeError, match="^analyze: as_xarray is not for Dask arrays and xarray.DataArrays$"):
        ptfe.analyze(532, 45, 0, xarray.DataArray(theta[:2], dims="view"), 180, as_xarray=True)


@pytest.fixture(scope="module")
def fitted(ptfe):
    """A fit of a sample, which knows what a reading of it will be."""
    return mmbrdf.fit(
        mmbrdf.simulate(ptfe, 532, mmbrdf.random_geometries(600, seed=1), speckle=0.01), orders=(3, 2)
    ).model


def test_predicted_readings_keep_names_and_stay_lazy(fitted):
    theta = np.array([0.0, 30.0, np.nan, 60.0])
    eager = fitted.predict_readings(532, 45, 0, theta, 180, invalid="nan")
    chunked = fitted.predict_readings(532, 45, 0, da.from_array(theta, chunks=2), 180, invalid="nan")
    view = xarray.DataArray(theta, {"view": [1, 2, 3, 4]}, dims="view")
    named = fitted.predict_readings(532, 45, 0, view, 180, invalid="nan")
    for one, lazy, labelled in zip(eager, chunked, named):
        same(lazy, one)
        np.testing.assert_array_equal(labelled.values, one)
        assert labelled.dims[0] == "view" and labelled.view.values.tolist() == [1, 2, 3, 4]
    assert [one.name for one in named] == list(named._fields) and named.validity.dtype == np.uint8
    assert named.value.dims == named.u.dims == ("view", "row", "column") and "units" not in named.value.attrs


def test_curves_of_polarization_keep_names_and_stay_lazy(fitted):
    plane = mmbrdf.in_plane(45, [-40, 0, 30, 60])
    place = {"place": list("abcd")}
    for ask in (mmbrdf.polarized_curve, mmbrdf.polarized_uncertainty):
        eager = ask(fitted, 532, plane)
        chunked = ask(fitted, 532, [da.from_array(one, chunks=2) for one in plane])
        named = ask(fitted, xarray.DataArray(532), [xarray.DataArray(one, place, dims="place") for one in plane])
        for name, one, lazy, labelled in zip(eager._fields, eager, chunked, named):
            same(lazy, one)
            np.testing.assert_array_equal(labelled.values, one)
            assert labelled.name == name and labelled.place.values.tolist() == list("abcd")
            assert labelled.attrs["units"] == "sr-1"
    image = [np.reshape(one, (2, 2)) for one in plane]
    curves = mmbrdf.polarized_curve(fitted, 532, [xarray.DataArray(one, dims=["y", "x"]) for one in image])
    assert curves.ss.dims == ("y", "x")
    whole = mmbrdf.polarized_curve(fitted, 532, mmbrdf.Geometry(*map(xarray.DataArray, plane)), uncertainty=True)
    expected = mmbrdf.polarized_curve(fitted, 532, plane, uncertainty=True)
    np.testing.assert_array_equal(whole.u.sp, expected.u.sp)
    np.testing.assert_array_equal(whole.validity, expected.validity)
    with pytest.raises(ValueError) as caught:
        mmbrdf.polarized_curve(fitted, 532, plane[:3])
    with pytest.raises(ValueError, match=re.escape(str(caught.value))):
        mmbrdf.polarized_curve(fitted, 532, [xarray.DataArray(one) for one in plane[:3]])


def wrong_calls(model, matrices):
    """Of a model and of functions, each with something wrong that the values of the lazy array have no part in."""
    sampler, instrument = mmbrdf.DirectionSampler(model, 532), mmbrdf.ideal_states(["s", "p", "+45", "L"])
    angle, ask = np.array([0.0, 30.0]), model.evaluate
    for wrong in (
        {"frame": "zz"}, {"theta_i": 1}, {"terms": {"scale": 0.1}}, {"invalid": "skip"}, {"threads": 1.5}, {"phi_i_deg": 1},
        {"uncertainty": True, "terms": {"skale": 0.1}}, {"uncertainty": True, "terms": 5}, {"as_printed": "yes"},
    ):  # fmt: skip
        yield angle, lambda a, wrong=wrong: ask(532, 45, 0, a, 180, **wrong)
    yield angle, lambda a: ask(532, 95, 0, a, 180)
    yield angle, lambda a: ask(-532, 45, 0, a, 180)
    yield angle, lambda a: ask(None, 45, 0, a, 180)
    yield angle, lambda a: ask(532, 45, [np.nan], a, 180)
    yield angle, lambda a: ask(532, "45", 0, a, 180)
    yield angle, lambda a: ask(532, [[45], [30, 20]], 0, a, 180)
    yield angle, lambda a: ask(532, 45, 0, a)
    yield angle, lambda a: ask(532, 45, 0, a, 180, "xy")
    yield angle, lambda a: ask(532, 45, a, 0, 180, theta_r_deg=0)
    yield angle.astype(complex), lambda a: ask(532, 45, 0, a, 180)
    yield angle, lambda a: model.evaluate_uncertainty(532, 45, 0, a, 180, terms={"scale": -1})
    yield angle, lambda a: model.evaluate_draws(0, 1, 532, 45, 0, a, 180)
    yield angle, lambda a: model.evaluate_draws("a", 1, 532, 45, 0, a, 180)
    yield angle, lambda a: model.analyze(532, 95, 0, a, 180)
    yield angle, lambda a: model.analyze(532, 45, 0, a, 180, stokes=[1, 2, 0, 0])
    yield angle, lambda a: mmbrdf.directional_hemispherical_reflectance(model, -532, a)
    yield angle, lambda a: mmbrdf.directional_hemispherical_reflectance(5, 532, a)
    yield angle, lambda a: mmbrdf.change_frame(np.eye(4), a, 0, 95, 0, "xy", "sp")
    yield angle, lambda a: sampler.sample(a, 0, 1.5, 0.2)
    yield angle, lambda a: mmbrdf.retarder(a, float("inf"))
    yield matrices, lambda a: mmbrdf.depolarization(a, invalid="skip")
    yield matrices, lambda a: mmbrdf.degree_of_polarization(a, [1, 2, 3])
    yield matrices, lambda a: mmbrdf.convert(a, "germer2017", "zz")
    yield np.ones((3, 4, 4)), lambda a: instrument.reduce(a, "skip")


def test_what_is_wrong_is_refused_at_the_call_with_the_words_of_the_eager_one(ptfe, random_matrices):
    for value, call in wrong_calls(ptfe, random_matrices):
        with pytest.raises((TypeError, ValueError)) as eager:
            call(value)
        names = [f"axis_{k}" for k in range(value.ndim - 2)] + ["row", "column"] if value.ndim > 1 else ["view"]
        for lazy in (da.from_array(value), xarray.DataArray(value, dims=names).chunk()):
            with pytest.raises(type(eager.value)) as caught:
                call(lazy)
            assert str(caught.value) == re.sub(r"(, at \[0\])+$", "", str(eager.value))  # it is wrong at all places


def test_nothing_of_a_lazy_array_is_computed_by_a_call(ptfe, random_matrices):
    def broken(block):
        raise AssertionError("computed")

    def never(shape):
        return da.zeros(shape, chunks=-1).map_blocks(broken, dtype=float, meta=np.zeros((0,) * len(shape)))

    angle, matrix = never((3,)), never((3, 4, 4))
    ptfe.evaluate(532, 45, 0, angle, 180, uncertainty=True, terms={"scale": 0.01})
    ptfe.analyze(532, 45, 0, angle, 180, stokes=[1, 0, 0, 1], draws=2)
    mmbrdf.polarized_curve(ptfe, 532, [45.0, 0.0, angle, 180.0], uncertainty=True)
    mmbrdf.directional_hemispherical_reflectance(ptfe, 532, angle)
    for q in mmbrdf.quantities():
        for name in (q.name, f"{q.name}_gradient"):
            getattr(mmbrdf, name)(matrix, *[[1, 0, 0, 0.5]] * q.takes_light)
    for name in ("lu_chipman", "cloude_decomposition", "symmetric_decomposition", "normalized", "nearest_realizable"):
        getattr(mmbrdf, name)(matrix)
    large = np.zeros((1000, 1000))  # which goes to every chunk, and is not tried as a whole
    assert ptfe.evaluate(532, da.zeros((1000, 1000)), 0, large, 180).shape == (1000, 1000, 4, 4)


def test_frames_and_conventions_that_there_are_not_are_refused_at_once(ptfe):
    for one in (lazy_question(), (*QUESTION[:3], xarray.DataArray(THETA_R), 30.0)):
        for method in ("evaluate", "evaluate_uncertainty", "covariance"):
            with pytest.raises(ValueError, match=r"^frame 'zz' is not one of xy, sp, scattering_plane$"):
                getattr(ptfe, method)(*one, frame="zz")
        values = ptfe.evaluate(*one)
        for frames in (("zz", "sp"), ("xy", "zz")):
            with pytest.raises(ValueError, match=r"^frame 'zz' is not one of"):
                mmbrdf.change_frame(values, *one[1:], *frames)
        with pytest.raises(ValueError, match=r"^convention 'zz' is not one of"):
            mmbrdf.convert(values, "zz", "germer2017")


def calls_of_shapes(model):
    """With shapes that do not go together; `z` makes an array of zeros."""
    yield lambda z: model.evaluate(532, 45, 0, z((3,)), z((4,)))
    yield lambda z: model.evaluate(532, 45, 0, z((3,)), [0.0, 1.0], invalid="nan")
    yield lambda z: model.evaluate(532, 45, 0, z((3000,)), np.zeros(2000))
    yield lambda z: mmbrdf.depolarization(z((5, 3, 3)))
    yield lambda z: mmbrdf.depolarization(z((4,)))
    yield lambda z: mmbrdf.polarized_curve(model, 532, [45.0, 0.0, z((3,)), z((4,))])
    yield lambda z: mmbrdf.change_frame(z((5, 4, 4)), z((3,)), 0, 0, 0, "xy", "sp")
    yield lambda z: mmbrdf.degree_of_polarization(z((5, 4, 4)), np.ones((3, 4)))
    yield lambda z: mmbrdf.standard_uncertainty(z((5, 4, 4)), z((5, 15, 16)))
    yield lambda z: mmbrdf.DirectionSampler(model, 532).sample(z((3,)), 0, z((4,)), 0.5)
    yield lambda z: mmbrdf.directional_hemispherical_reflectance(model, 532, z((3,)), z((2,)))


def test_shapes_that_do_not_go_together_are_refused_at_the_call_with_the_words_of_the_eager_one(ptfe):
    for call in calls_of_shapes(ptfe):
        with pytest.raises(ValueError, match="shape") as eager:
            call(np.zeros)
        with pytest.raises(ValueError) as lazy:
            call(lambda shape: da.zeros(shape, chunks=2))
        assert str(lazy.value) == str(eager.value)


def test_draws_are_not_made_twice(samples, monkeypatch):
    small = mmbrdf.fit(samples, orders=(2, 1), uncertainty="noise").model
    asked = []
    for name in ("Model.analyze", "Model.evaluate_draws"):
        of = mmbrdf._chunks.FUNCTIONS[name]
        many = lambda draws=0, count=0, of=of, **more: (
            asked.append(draws or count),
            of(**({"draws": draws} if draws else {"count": count}), **more),
        )[1]
        monkeypatch.setitem(mmbrdf._chunks.FUNCTIONS, name, many)
    theta_r = xarray.DataArray([0.0, 30.0], dims="view")
    small.analyze(532, 45, 0, theta_r, 180, draws=200)
    small.evaluate_draws(200, 1, 532, 45, 0, theta_r, 180)
    assert asked == [2, 200] * 2
