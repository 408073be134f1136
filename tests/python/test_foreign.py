# SPDX-License-Identifier: BSD-3-Clause
"""Files that Python tools of the field write, made samples by the program."""
import os
import subprocess
import sys

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


def test_read_foreign_gives_what_the_program_writes(tmp_path):
    text = "VARS theta_i,phi_i,theta_s,phi_s,R,G\n0.5,0,0.25,3,0.31,0.32\n0.5,0,1.5707963,3,0.1,0.1\n"
    (tmp_path / "x.astm").write_text(text)
    data = mmbrdf.read_foreign(tmp_path / "x.astm", wavelength_nm=[633, 532])
    same, _ = converted(tmp_path / "x.astm", tmp_path / "x.csv", "--wavelength", "633,532")
    np.testing.assert_array_equal(data.f11, [0.31, 0.32])
    np.testing.assert_array_equal(data.f11, same.f11)
    np.testing.assert_array_equal(data.wavelength_nm, same.wavelength_nm)
    assert "as told" in data.read_as and "2 of 4 values at or below the horizon" in data.read_as


def test_what_a_file_does_not_say_is_asked_for(tmp_path):
    (tmp_path / "x.astm").write_text("VARS theta_i,phi_i,theta_s,phi_s,BRDF\n0.5,0,0.25,3,0.31\n")
    with pytest.raises(OSError, match="does not say the wavelength.*wavelength_nm=NM"):
        mmbrdf.read_foreign(tmp_path / "x.astm")
    with pytest.raises(OSError, match="is an ASTM E1392 or E2387 file"):
        mmbrdf.read_samples(tmp_path / "x.astm")
    with pytest.raises(OSError, match="is an ASTM E1392 or E2387 file"):
        mmbrdf.load(tmp_path / "x.astm")
    with pytest.raises(FileNotFoundError):
        mmbrdf.read_foreign(tmp_path / "nowhere")


@pytest.fixture
def netcdf(tmp_path):
    pytest.importorskip("netCDF4")
    array = mmbrdf.material("ptfe").evaluate(532, [10.0, 20, 30], 0, [[0.0], [20], [40]], 180, as_xarray=True)
    array.to_netcdf(tmp_path / "x.nc")
    return tmp_path / "x.nc"


def test_many_threads_read_netcdf_at_once_and_in_turn(netcdf, tmp_path):
    # In a process of its own: what goes wrong ends it, or fills its standard error.
    code = (
        "import sys, mmbrdf\n"
        "from concurrent.futures import ThreadPoolExecutor\n"
        "mmbrdf.read_foreign(sys.argv[1])\n"
        "with ThreadPoolExecutor(8) as pool:\n"
        "    print(sum(len(data) for data in pool.map(mmbrdf.read_foreign, [sys.argv[1]] * 400)))\n"
    )
    run = subprocess.run([sys.executable, "-c", code, netcdf], capture_output=True, text=True)
    assert (run.returncode, run.stdout, run.stderr) == (0, "3600\n", "")


def test_without_the_library_a_netcdf_file_is_refused_with_what_to_install(netcdf, tmp_path):
    program = os.environ["MMBRDF_PROGRAM"]
    failing = os.path.join(os.path.dirname(program), "tests", "libfailing.so")
    if not os.path.exists(failing):
        pytest.skip("no library that makes calls fail: tests are not built")
    environment = dict(os.environ, LD_PRELOAD=failing, FAIL="dlopen:1:error")
    run = subprocess.run(
        [program, "convert", netcdf, tmp_path / "x.csv"], env=environment, capture_output=True, text=True
    )
    assert run.returncode == 1
    assert run.stderr.startswith(f"mmbrdf: {netcdf}: a NetCDF file, but libnetcdf")
    assert run.stderr.endswith("install netCDF-C (Debian: libnetcdf19)\n")
    assert not (tmp_path / "x.csv").exists()
