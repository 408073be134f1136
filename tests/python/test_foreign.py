# SPDX-License-Identifier: BSD-3-Clause
"""Files that Python tools of the field write, made samples by the program."""
import os
import subprocess

import numpy as np
import pytest

import mmbrdf


def converted(path, out, *options):
    """The samples that the program makes of a file, and its note."""
    program = os.environ["MMBRDF_PROGRAM"]
    run = subprocess.run([program, "convert", path, out, *options], check=True, capture_output=True, text=True)
    return mmbrdf.read_samples(out), run.stderr


@pytest.mark.parametrize("frame", ["xy", "sp", "scattering_plane"])
def test_what_xarray_saves_comes_back_as_samples(tmp_path, frame):
    pytest.importorskip("xarray")
    pytest.importorskip("netCDF4")
    model = mmbrdf.material("ptfe")
    array = model.evaluate(
        wavelength_nm=np.array([450.0, 532.0])[:, None, None],
        theta_i_deg=np.array([10.0, 50.0])[:, None, None, None],
        phi_i_deg=20.0,
        theta_r_deg=np.array([0.0, 40.0, 70.0])[:, None],
        phi_r_deg=np.array([0.0, 90.0, 180.0, 270.0]),
        frame=frame,
        as_xarray=True,
    )
    array.to_netcdf(tmp_path / "x.nc")
    data, note = converted(tmp_path / "x.nc", tmp_path / "x.csv")
    assert f"frame {frame}, convention germer2017" in note
    assert len(data) == 48
    expected = model.evaluate(data.wavelength_nm, *data.geometry)
    np.testing.assert_allclose(data.mueller, expected, rtol=0, atol=1e-13)


def test_coordinates_may_share_an_axis(tmp_path):
    pytest.importorskip("xarray")
    pytest.importorskip("netCDF4")
    model = mmbrdf.material("ptfe-532")
    angles = np.linspace(5, 70, 9)
    array = model.evaluate(532.0, angles, 3 * angles, angles[::-1], 4 * angles, as_xarray=True)
    array.to_netcdf(tmp_path / "x.nc")
    data, _ = converted(tmp_path / "x.nc", tmp_path / "x.csv")
    np.testing.assert_allclose(data.theta_r_deg, angles[::-1], atol=1e-12)
    np.testing.assert_allclose(data.mueller, model.evaluate(532.0, *data.geometry), rtol=0, atol=1e-13)
