# SPDX-License-Identifier: BSD-3-Clause
"""What every question to a model may say besides: uncertainty, invalid, as_xarray. One idea, the same for all."""

import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import mmbrdf
from mmbrdf import Outside, _asking, _mmbrdf

TERMS = {"scale": 0.003, "theta_r_deg": 0.1}
ANGLES = ("theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg")


def quietly(call, *given, **named):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mmbrdf.ExtrapolationWarning)
        return call(*given, **named)


def names_of(function):
    return list(function.__signature__.parameters)


def functions():
    for name in sorted(set(_asking.QUESTIONS) - {"average"}):
        yield name, _asking._named(_mmbrdf, name)


def question(name, model, shape=(3, 2)):
    """Arguments of a question of this shape, all valid; with one place in each that may be spoilt."""
    rng = np.random.default_rng(5)
    parameters = names_of(_asking._named(_mmbrdf, name))
    asked = mmbrdf.DirectionSampler(model, 532) if name.startswith("DirectionSampler") else model
    arguments = {one: asked for one in ("self", "model") if one in parameters}
    spoilt = {"theta_i_deg": 90.5, "theta_r_deg": np.nan, "phi_i_deg": np.inf, "phi_r_deg": np.nan}
    spoilt.update(wavelength_nm=-1.0, stokes=[1, np.nan, 0, 0], analyzer=[np.nan, 0, 0, 0])
    ranges = {"wavelength_nm": (400, 900), "theta_i_deg": (-60, 60), "theta_r_deg": (-60, 60)}
    for argument in ("wavelength_nm", *ANGLES):
        if argument in parameters:
            arguments[argument] = rng.uniform(*ranges.get(argument, (0, 360)), shape)
    if "geometry" in parameters:
        arguments.update(wavelength_nm=532.0, geometry=[rng.uniform(0, 60, shape) for _ in range(4)])
    if "mueller" in parameters:
        arguments.update(mueller=rng.normal(size=(*shape, 4, 4)), from_frame="xy", to_frame="sp")
    if "pdf" in parameters:
        arguments["pdf"] = rng.uniform(0.1, 1, shape)
    if "count" in parameters:
        arguments.update(count=4, seed=1)
    if name == "Model.predict_readings":
        arguments["wavelength_nm"] = np.full(shape, 532.0)
    for light in ("stokes", "analyzer"):
        if light in parameters and name != "Model.analyze":
            arguments[light] = np.broadcast_to([1.0, 0.2, 0, 0], (*shape, 4)).copy()
    return arguments, spoilt


def leaves(result):
    if isinstance(result, dict):
        result = tuple(result.values())
    if isinstance(result, tuple):
        for one in result:
            yield from leaves(one)
    else:
        yield np.asarray(result)


@pytest.mark.parametrize("name, function", functions(), ids=lambda x: x if isinstance(x, str) else "")
def test_nan_goes_in_and_nan_comes_out_and_all_else_is_as_without_it(name, function, ptfe):
    arguments, spoilt = question(name, ptfe)
    leading = _asking.QUESTIONS[name].leading
    whole = quietly(function, **arguments)
    for argument in [*arguments, "geometry"]:
        if argument == "geometry" in arguments:
            bad = {**arguments, "geometry": [one.copy() for one in arguments["geometry"]]}
            bad["geometry"][2][1, 0] = np.nan
            place = (2,)  # one behind the other
        elif argument in spoilt and np.ndim(arguments.get(argument)) >= 2:
            bad = {**arguments, argument: arguments[argument].copy()}
            bad[argument][1, 0] = spoilt[argument]
            place = (1, 0)
        else:
            continue
        with pytest.raises(ValueError):
            quietly(function, **bad)
        found = quietly(function, **bad, invalid="nan")
        for one, before in zip(leaves(found), leaves(whole), strict=True):
            lead = () if one.dtype == np.uint8 else (slice(None),) * leading
            assert one.shape == before.shape and one.dtype == before.dtype
            there = one[(*lead, *place)]
            expected = Outside.NOT_VALID if one.dtype == np.uint8 else False if one.dtype == bool else np.nan
            np.testing.assert_array_equal(there, expected)
            valid = np.ones(whole_shape(one, before, leading, arguments), bool)
            valid[place] = False
            np.testing.assert_array_equal(one[(*lead, valid)], before[(*lead, valid)])


def whole_shape(one, before, leading, arguments):
    return (6,) if "geometry" in arguments else (3, 2)


@pytest.mark.parametrize("name, function", functions(), ids=lambda x: x if isinstance(x, str) else "")
def test_what_is_valid_is_asked_as_it_was(name, function, ptfe):
    arguments, _ = question(name, ptfe)
    for one, before in zip(
        leaves(quietly(function, **arguments, invalid="nan")), leaves(quietly(function, **arguments)), strict=True
    ):
        np.testing.assert_array_equal(one, before)


@pytest.mark.parametrize(
    "name, function",
    [(n, f) for n, f in functions() if _asking.QUESTIONS[n].uncertainty],
    ids=lambda x: x if isinstance(x, str) else "",
)
@pytest.mark.parametrize("terms", [None, TERMS])
def test_value_u_and_validity_come_together(name, function, terms, ptfe):
    """They are what three calls give, of one argument list."""
    arguments, _ = question(name, ptfe)
    found = quietly(function, **arguments, uncertainty=True, terms=terms)
    assert isinstance(found, mmbrdf.Evaluation)
    other = _asking._named(_mmbrdf, _asking.QUESTIONS[name].uncertainty)
    for one, apart in (
        (found.value, quietly(function, **arguments)),
        (found.u, quietly(other, **arguments, terms=terms)),
    ):
        for a, b in zip(leaves(one), leaves(apart), strict=True):
            np.testing.assert_array_equal(a, b)
    assert found.validity.dtype == np.uint8
    where = arguments if "geometry" not in arguments else dict(zip(ANGLES, map(np.ravel, arguments["geometry"])))
    asked = {a: where.get(a, 0.0) for a in ANGLES}
    np.testing.assert_array_equal(found.validity, ptfe.outside(arguments["wavelength_nm"], **asked))


def test_numbers_give_numbers(ptfe):
    found = ptfe.reflectance_factor(532, 0, 0, 45, 0, uncertainty=True, terms={"scale": 0.003})
    assert all(np.ndim(one) == 0 for one in found) and found.validity == Outside.INSIDE
    assert found.value == np.pi * ptfe.evaluate(532, 0, 0, 45, 0)[0, 0]
    nothing = ptfe.reflectance_factor(532, 0, 0, float("nan"), 0, uncertainty=True, invalid="nan")
    assert np.isnan(nothing.value) and np.isnan(nothing.u) and nothing.validity == Outside.NOT_VALID
    assert ptfe.reflectance_factor(532, 0, 0, 45, 0) == found.value
    assert mmbrdf.directional_hemispherical_reflectance(ptfe, 532, 8, uncertainty=True).value < 1


def test_one_light_for_all_is_left_as_it_is(ptfe):
    found = ptfe.analyze(532, [45, np.nan], 0, 30, 180, stokes=[1, 0, 0, -1], invalid="nan")
    alone = ptfe.analyze(532, 45, 0, 30, 180, stokes=[1, 0, 0, -1])
    assert found["scattered_S1"].value[0] == alone["scattered_S1"].value and np.isnan(found["scattered_S1"].u[1])
    nothing = ptfe.analyze(532, np.nan, 0, 30, 180, stokes=[1, 0, 0, -1], invalid="nan", as_xarray=False)
    assert np.isnan(nothing["f_ss"].value) and np.ndim(nothing["f_ss"].value) == 0
    dhr = mmbrdf.directional_hemispherical_reflectance
    assert dhr(ptfe, 532, [8, np.nan], stokes=[1, 1, 0, 0], invalid="nan")[0] == dhr(ptfe, 532, 8, stokes=[1, 1, 0, 0])
    assert np.isnan(dhr(ptfe, 532, [8, 9], stokes=[1, np.nan, 0, 0], invalid="nan")).all()
    assert np.isnan(dhr(ptfe, [532, -1, np.inf, 1.1e9], 8, invalid="nan")).tolist() == [False, True, True, True]


def test_masked_arrays_are_nan_if_that_is_asked_for(ptfe):
    angles = np.ma.masked_array([0.0, 30.0, 60.0], mask=[False, True, False])
    with pytest.raises(ValueError, match="masked"):
        ptfe.evaluate(532, 45, 0, angles, 180)
    found = ptfe.evaluate(532, 45, 0, angles, 180, invalid="nan")
    np.testing.assert_array_equal(np.isnan(found).all(axis=(1, 2)), angles.mask)
    np.testing.assert_array_equal(found[[0, 2]], ptfe.evaluate(532, 45, 0, [0, 60], 180))


def test_the_edges_of_what_is_valid_are_those_that_are_refused(ptfe):
    """The mask is numpy's; what it lets through the library takes, and the rest it refuses."""
    for theta in (90.0, np.nextafter(90, 91), -90.0, -np.nextafter(90, 91), np.nan, np.inf):
        for phi in (0.0, 1e9, np.nan, -np.inf):
            found = quietly(ptfe.evaluate, 532, theta, 0, 10, phi, invalid="nan")
            if np.isnan(found).any():
                with pytest.raises(ValueError):
                    quietly(ptfe.evaluate, 532, theta, 0, 10, phi)
            else:
                np.testing.assert_array_equal(found, quietly(ptfe.evaluate, 532, theta, 0, 10, phi))


def test_nothing_valid_is_no_error(ptfe):
    for shape in ((), (2,), (0,), (2, 0)):
        found = ptfe.evaluate(532, np.full(shape, np.nan), 0, 30, 180, uncertainty=True, invalid="nan")
        assert found.value.shape == (*shape, 4, 4) and np.isnan(found.value).all() and np.isnan(found.u).all()
        assert (np.asarray(found.validity) == Outside.NOT_VALID).all()


def test_out_takes_nan_too(ptfe):
    out = np.zeros((2, 4, 4))
    assert ptfe.evaluate(532, 45, 0, [30, np.nan], 180, out=out, invalid="nan") is out
    assert np.isnan(out[1]).all() and np.isfinite(out[0]).all()


def test_only_what_is_valid_counts_as_extrapolated(ptfe):
    with pytest.warns(mmbrdf.ExtrapolationWarning, match="1 of 2 questions lies") as caught:
        ptfe.evaluate(532, 45, 0, [30, np.nan, 89], 180, invalid="nan", uncertainty=True)
    assert len(caught) == 1


def test_u_needs_to_be_asked_for(ptfe):
    with pytest.raises(ValueError, match="terms: these are of u, give uncertainty=True"):
        ptfe.evaluate(532, 45, 0, 30, 180, terms=TERMS)
    with pytest.raises(ValueError, match="invalid: expected 'raise' or 'nan', not 'drop'"):
        ptfe.evaluate(532, 45, 0, 30, 180, invalid="drop")
    with pytest.raises(ValueError, match="not known"):
        mmbrdf.in_published_form(ptfe).evaluate(532, 45, 0, 30, 180, uncertainty=True)


def test_a_mean_over_apertures_comes_with_u_and_validity(ptfe):
    source, receiver = mmbrdf.Aperture.cone(45, 0, 3), mmbrdf.Aperture.cone(78, 180, 5)
    found = quietly(mmbrdf.average, ptfe, 532, source, receiver, uncertainty=True, terms=TERMS)
    np.testing.assert_array_equal(found.value, quietly(mmbrdf.average, ptfe, 532, source, receiver)[0])
    np.testing.assert_array_equal(found.u, mmbrdf.average_uncertainty(ptfe, 532, source, receiver, terms=TERMS))
    np.testing.assert_allclose(receiver.largest_theta_deg, 83, rtol=1e-12)
    assert found.validity == Outside.THETA_R  # up to 83 degrees, and 81.9 are fitted
    assert quietly(mmbrdf.average, ptfe, 532, source, source, uncertainty=True).validity == Outside.INSIDE


def test_curves_have_terms(ptfe):
    where = mmbrdf.in_plane(45, [-30, 10, 60])
    found = mmbrdf.polarized_curve(ptfe, 532, where, uncertainty=True, terms=TERMS)
    expected = mmbrdf.standard_uncertainty(
        mmbrdf.f_sp_gradient(np.eye(4)), ptfe.covariance(532, *where, frame="sp", terms=TERMS)
    )
    np.testing.assert_allclose(found.u.sp, expected, rtol=1e-12)  # a sum in another order
    assert (found.u.ss > mmbrdf.polarized_uncertainty(ptfe, 532, where).ss).all()


def test_names_come_along(ptfe):
    xarray = pytest.importorskip("xarray")
    theta = [0.0, 30.0, np.nan, 85.0]
    found = quietly(
        ptfe.evaluate, 532, 45, 0, theta, 180, frame="sp", uncertainty=True, terms=TERMS, invalid="nan", as_xarray=True
    )
    assert isinstance(found, xarray.Dataset) and found.attrs["Conventions"].startswith("CF-")
    plain = quietly(ptfe.evaluate, 532, 45, 0, theta, 180, frame="sp", uncertainty=True, terms=TERMS, invalid="nan")
    np.testing.assert_array_equal(found.brdf, plain.value)
    np.testing.assert_array_equal(found.uncertainty, plain.u)
    np.testing.assert_array_equal(found.validity, plain.validity)
    assert found.brdf.dims == ("theta_r_deg", "row", "column") and found.validity.dims == ("theta_r_deg",)
    assert found.brdf.attrs["ancillary_variables"] == "uncertainty validity" and found.brdf.attrs["units"] == "sr-1"
    flags = found.validity.attrs
    named = dict(zip(flags["flag_meanings"].split(), flags["flag_masks"], strict=True))
    assert named == {
        "outside_theta_i": 1,
        "outside_theta_r": 2,
        "outside_wavelength": 4,
        "unknown_range": 8,
        "outside_directions": 16,
        "interpolated": 32,
        "not_valid": 64,
    }
    assert flags["flag_masks"].dtype == found.validity.dtype == np.uint8
    one = ptfe.reflectance_factor(532, [0.0, 30.0], 0, 45, 0, as_xarray=True)
    assert one.name == "reflectance_factor" and one.dims == ("theta_i_deg",) and one.attrs["units"] == "1"
    both = ptfe.reflectance_factor(532, [0.0, 30.0], 0, 45, 0, as_xarray=True, uncertainty=True)
    assert set(both.data_vars) == {"reflectance_factor", "uncertainty", "validity"}
    dhr = mmbrdf.directional_hemispherical_reflectance(
        ptfe, [[443], [532]], [0, 8, 45], as_xarray=True, uncertainty=True
    )
    assert dhr.dhr.dims == ("wavelength_nm", "theta_i_deg") and "theta_r_deg" not in dhr.coords


def test_an_analysis_has_names_and_goes_into_a_file(ptfe, tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("netCDF4")
    found = ptfe.analyze(532, 45, 0, [0, 30], 180, stokes=[1, 0, 0, -1], terms=TERMS, as_xarray=True)
    plain = ptfe.analyze(532, 45, 0, [0, 30], 180, stokes=[1, 0, 0, -1], terms=TERMS)
    assert {about.name for about in mmbrdf.quantities()} <= set(found.data_vars)
    for name, one in plain.items():
        np.testing.assert_array_equal(found[name], one.value)
        np.testing.assert_array_equal(found[f"u_{name}"], one.u)
        np.testing.assert_array_equal(found[f"u_{name}_parts"].sel(part="scale"), one.parts["scale"])
    found.to_netcdf(tmp_path / "analysis.nc")
    with xarray.open_dataset(tmp_path / "analysis.nc") as again:
        np.testing.assert_array_equal(again.depolarization, found.depolarization)
        assert again.validity.attrs["flag_meanings"] == found.validity.attrs["flag_meanings"]


def test_the_reflectance_factor_of_named_arrays_keeps_the_names(ptfe):
    pytest.importorskip("xarray")
    f = ptfe.evaluate(532, 0, 0, [0.0, 30.0, 45.0], 0, as_xarray=True)
    with pytest.raises(ValueError, match=r"^f11: sixteen elements, expected one: give f.sel\(row=1, column=1\)$"):
        mmbrdf.reflectance_factor(f)
    factor = mmbrdf.reflectance_factor(f.sel(row=1, column=1))
    assert factor.dims == ("theta_r_deg",) and factor.attrs["units"] == "1" and factor.name == "reflectance_factor"
    np.testing.assert_array_equal(factor.theta_r_deg, f.theta_r_deg)
    np.testing.assert_array_equal(factor, ptfe.reflectance_factor(532, 0, 0, [0.0, 30.0, 45.0], 0))


def test_readings_are_predicted_with_their_noise(samples):
    model = mmbrdf.fit(samples, weights="speckle").model
    where = mmbrdf.in_plane(45, [-30, 30])
    found = model.predict_readings(532, *where)
    f = model.evaluate(532, *where)
    np.testing.assert_allclose(found.value[:, 0, 0], f[:, 0, 0], rtol=1e-12)
    np.testing.assert_allclose(found.value[:, 1, 1], f[:, 1, 1] / f[:, 0, 0], rtol=1e-12)
    assert (found.u[:, 0, 0] > model.evaluate_uncertainty(532, *where)[:, 0, 0]).all()
    # speckle 0.01 sqrt(cos theta_i / cos theta_r): of simulated readings nearly all u; 10 % of that for the fit of the noise
    law = 0.01 * np.sqrt(np.cos(np.radians(45)) / np.cos(np.radians(where.theta_r_deg)))
    np.testing.assert_allclose(found.u[:, 0, 0] / f[:, 0, 0], law, rtol=0.1)
    own = model.predict_readings(532, *where, at_its_azimuth=True)
    assert own.value.shape == (2, 4, 4) and (own.validity == Outside.INSIDE).all()
    with pytest.raises(ValueError, match="noise alone"):
        mmbrdf.fit(samples, uncertainty="noise").model.predict_readings(532, *where)


def test_the_calls_of_the_documentation_give_what_stands_beside_them(ptfe):
    page = (Path(__file__).parents[2] / "docs/python.md").read_text(encoding="utf-8")
    block = page[page.index("### Value, u and validity") :].split("```")[1].removeprefix("python\n")
    names = {"model": ptfe, "mmbrdf": mmbrdf}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mmbrdf.ExtrapolationWarning)
        exec(block, names)
        lines = block.splitlines()
        shown = repr(eval(lines[2].partition("#")[0], names))
        assert re.sub(r"\s+", "", shown) == re.sub(r"\s+", "", lines[2].partition("#")[2])
        assert repr(eval(lines[3].partition("#")[0], names)) == lines[3].partition("# ")[2].partition(";")[0]
    assert 0 < names["u"] < 0.01 < names["value"] and names["validity"] == Outside.INSIDE


def test_functions_of_matrices_and_readings_have_nan_for_what_is_masked(random_matrices):
    hidden = np.ma.masked_array(random_matrices, np.zeros(random_matrices.shape, bool))
    hidden[2, 3, 1, 1] = np.ma.masked
    missing = np.where(np.ma.getmaskarray(hidden), np.nan, random_matrices)
    for ask in (mmbrdf.depolarization, mmbrdf.nearest_realizable, mmbrdf.realizability_margin):
        np.testing.assert_array_equal(ask(hidden, invalid="nan"), ask(missing, invalid="nan"))
        with pytest.raises(ValueError, match="^mueller: a part of it is masked; leave it out$"):
            ask(hidden)
    instrument = mmbrdf.ideal_polarimeter(131.81, [-51.69, -15.12, 15.12, 51.69])
    for dtype in (np.float32, np.float64):
        readings = np.ma.masked_array(instrument.readings(random_matrices).astype(dtype), np.ma.getmaskarray(hidden))
        for found in (instrument.reduce(readings, invalid="nan"), instrument.reduce(readings, "nan")):
            assert np.argwhere(np.isnan(found).any(axis=(-2, -1))).tolist() == [[2, 3]] and found.dtype == dtype
        with pytest.raises(ValueError, match="^readings: a part of it is masked; leave it out$"):
            instrument.reduce(readings)


def test_masked_whole_numbers_are_reduced_in_double_precision(random_matrices):
    instrument = mmbrdf.ideal_polarimeter(131.81, [-51.69, -15.12, 15.12, 51.69])
    counts = np.ma.masked_array(np.rint(1e9 * instrument.readings(random_matrices)).astype(np.int64))
    expected = instrument.reduce(counts.data)
    counts[2, 3, 1, 1] = np.ma.masked
    expected[2, 3] = np.nan
    found = instrument.reduce(counts, invalid="nan")
    assert found.dtype == float
    np.testing.assert_array_equal(found, expected)


def test_what_is_masked_within_a_list_does_not_count_either(ptfe, random_matrices):
    angles = np.ma.masked_array([0.0, 30.0, 60.0], [False, True, False])
    there = np.array([True, False, True])
    plain = ptfe.evaluate(532, 45, 0, np.array([angles.data] * 2), 180)
    for given in ([angles, angles], (angles, list(angles)), [angles, [0.0, np.ma.masked, 60.0]]):
        found = ptfe.evaluate(532, 45, 0, given, 180, invalid="nan")
        np.testing.assert_array_equal(found[:, there], plain[:, there])
        assert np.isnan(found[:, 1]).all()
    hidden = np.ma.masked_array(random_matrices, np.zeros(random_matrices.shape, bool))
    hidden[2, 3, 1, 1] = np.ma.masked
    for rows in (list(hidden), [list(row) for row in hidden]):
        assert np.argwhere(np.isnan(mmbrdf.depolarization(rows, invalid="nan"))).tolist() == [[2, 3]]
    with pytest.raises(ValueError, match="^theta_i_deg: a part of it is masked; leave it out$"):
        mmbrdf.images.PixelFit(532, ([angles, angles], 0, 0, 0))
