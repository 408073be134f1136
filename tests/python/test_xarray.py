# SPDX-License-Identifier: BSD-3-Clause
"""Names of axes, coordinates and attributes of labelled results."""

import json

import numpy as np
import pytest

import mmbrdf
from mmbrdf import _xarray

xarray = pytest.importorskip("xarray")


def labelled(model, *question, quantity="brdf", **options):
    """As Model.evaluate(*question, as_xarray=True) has it."""
    names = ("wavelength_nm", "theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg")
    arguments = {name: None if value is None else np.asarray(value, float) for name, value in zip(names, question)}
    values = model.evaluate(*question)
    return _xarray.labelled(values, quantity, model, "xy", arguments, **options)


@pytest.mark.parametrize(
    "question, names",
    [
        (([[532.0]], 45, 0, [30.0], 180), ["wavelength_nm", "theta_r_deg"]),
        (([532.0], 45, 0, 30, 180), ["wavelength_nm"]),
        (([[532.0]], 45, 0, [10.0, 30.0], 180), ["wavelength_nm", "theta_r_deg"]),
        (([[532.0], [633.0]], 45, 0, [30.0], 180), ["wavelength_nm", "theta_r_deg"]),
        (([[[532.0]]], [[45.0], [60.0]], 0, [30.0], 180), ["wavelength_nm", "theta_i_deg", "theta_r_deg"]),
        # Of two that begin with an axis of length 1 none spans it alone; an axis that none begins with has no name.
        (([532.0], 45, 0, [30.0], 180), ["axis_0"]),
        (([[532.0]], 45, 0, 30, 180), ["wavelength_nm", "axis_1"]),
        ((532, 45, 0, [[10.0, 30.0]], 180), ["axis_0", "theta_r_deg"]),
        # As it was for longer ones.
        ((532, 45, 0, [10.0, 30.0], [0.0, 180.0]), ["axis_0"]),
        ((532, 45, 0, [[10.0, 30.0], [20.0, 40.0]], 180), ["axis_0", "axis_1"]),
    ],
)
def test_an_axis_that_one_argument_alone_spans_has_its_name(ptfe, question, names):
    result = labelled(ptfe, *question)
    assert list(result.dims) == [*names, "row", "column"]
    np.testing.assert_array_equal(result.values, ptfe.evaluate(*question))
    coordinates = ("wavelength_nm", "theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg")
    for name, value in zip(coordinates, question):
        broadcast = result.coords[name].broadcast_like(result.isel(row=0, column=0, drop=True))
        np.testing.assert_array_equal(broadcast.values, np.broadcast_to(value, result.shape[:-2]))


def test_the_own_wavelength_of_a_model_is_a_coordinate():
    result = labelled(mmbrdf.material("ptfe-532"), None, 45, 0, [10.0, 30.0], 180)
    assert result.wavelength_nm == 532 and result.wavelength_nm.dims == ()
    assert result.wavelength_nm.attrs["units"] == "nm"


def test_a_wavelength_that_nobody_knows_is_none(tmp_path):
    mmbrdf.in_published_form(mmbrdf.material("ptfe-532")).save(tmp_path / "model.csv")
    assert "wavelength_nm" not in labelled(mmbrdf.load(tmp_path / "model.csv"), None, 45, 0, 30, 180).coords


def test_attributes_say_how_it_was_evaluated(ptfe, tmp_path):
    plain = labelled(ptfe, 532, 45, 0, 30, 180)
    assert plain.attrs["as_printed"] == 0 and "terms" not in plain.attrs
    assert labelled(ptfe, 532, 45, 0, 30, 180, as_printed=True).attrs["as_printed"] == 1
    data = mmbrdf.simulate(ptfe, 532, mmbrdf.random_geometries(300, seed=5))
    printed = mmbrdf.fit(data, "germer2017", (4, 2), as_printed=True).model
    assert labelled(printed, 532, 45, 0, 30, 180).attrs["as_printed"] == 1
    of_the_fit = labelled(ptfe, 532, 45, 0, 30, 180, quantity="uncertainty")
    assert of_the_fit.attrs["terms"] == "{}"
    terms = {"scale": 0.003, "theta_i_deg": 0.1}
    more = labelled(ptfe, 532, 45, 0, 30, 180, quantity="uncertainty", terms=terms)
    assert json.loads(more.attrs["terms"]) == terms
    pytest.importorskip("netCDF4")
    more.to_netcdf(tmp_path / "uncertainty.nc")
    with xarray.open_dataarray(tmp_path / "uncertainty.nc") as read:
        assert read.attrs["as_printed"] == 0 and json.loads(read.attrs["terms"]) == terms
