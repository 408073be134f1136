# SPDX-License-Identifier: BSD-3-Clause
"""Models as radiative transfer and Earth observation take them, read with the tools of the field."""
import shutil
import subprocess
import warnings

import numpy as np
import pytest

import mmbrdf

PTFE = mmbrdf.material("ptfe")
pytestmark = pytest.mark.filterwarnings("ignore::mmbrdf.ExtrapolationWarning")  # tables reach the horizon


def test_moments_add_up_to_the_model():
    mu_i, mu_r = [0.2, 0.7, 1], [0.4, 0.9]
    cosine, sine = PTFE.fourier_moments(532, mu_i, mu_r)
    assert cosine.shape == sine.shape == (2, 3, 14, 4, 4)
    m = np.arange(14)[:, None, None]
    for phi in [0, 33, 180, 290]:
        f = (cosine * np.cos(m * np.radians(phi)) + sine * np.sin(m * np.radians(phi))).sum(axis=2)
        theta_i, theta_r = np.degrees(np.arccos(mu_i)), np.degrees(np.arccos(mu_r))[:, None]
        np.testing.assert_allclose(f, PTFE.evaluate(532, theta_i, 50, theta_r, 50 + phi, frame="sp"), atol=1e-13)


def test_moments_of_a_model_with_an_azimuth_of_its_own_are_refused(anisotropic):
    for ask in [
        lambda: anisotropic.fourier_moments(532, 0.5, 0.5),
        lambda: mmbrdf.pythonic_disort_modes(anisotropic, 532, streams=8),
    ]:
        with pytest.raises(ValueError, match="depends on the azimuth of the source"):
            ask()
    with pytest.raises(ValueError, match="depends on the azimuth of the source"):
        mmbrdf.py6s_surface(anisotropic, 532, sun_deg=30, view_deg=10, azimuth_deg=40)


def test_cosines_are_those_of_a_hemisphere():
    with pytest.raises(ValueError, match="mu_incident = 1.5, a cosine must be in 0...1"):
        PTFE.fourier_moments(532, 1.5, 0.5)


def warned(category, ask):
    """What a call warns of, once each."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ask()
    return [str(one.message) for one in caught if one.category is category]


def test_radiative_transfer_warns_once_of_what_is_extrapolated():
    for ask in [
        lambda: PTFE.fourier_moments(100, 0.9, 0.9),
        lambda: PTFE.fourier_moments(532, [0.9, 0.05], [0.9, 0.05]),
        lambda: mmbrdf.pythonic_disort_modes(PTFE, 100, streams=16),
        lambda: mmbrdf.pythonic_disort_modes(PTFE, 532, streams=16),
        lambda: mmbrdf.py6s_surface(PTFE, 100, sun_deg=85, view_deg=10, azimuth_deg=40),
        lambda: mmbrdf.py6s_surface(PTFE, 532, sun_deg=30, view_deg=10, azimuth_deg=40),
    ]:
        assert len(warned(mmbrdf.ExtrapolationWarning, ask)) == 1
    assert not warned(mmbrdf.ExtrapolationWarning, lambda: PTFE.fourier_moments(532, [0.5, 1], [0.4, 0.9]))
    [pairs] = warned(mmbrdf.ExtrapolationWarning, lambda: PTFE.fourier_moments(532, [0.9, 0.05], [0.9, 0.5, 0.4]))
    assert "3 of 6 questions lie outside the fitted range (theta_i" in pairs
    modes = mmbrdf.pythonic_disort_modes(PTFE, 532, streams=16)
    assert len(warned(mmbrdf.ExtrapolationWarning, lambda: modes[3](0.05, 0.05))) == 1
    assert not warned(mmbrdf.ExtrapolationWarning, lambda: modes[3](0.5, 0.5))


def test_functions_for_pythonic_disort_say_how_many_are_left_out():
    [said] = warned(UserWarning, lambda: mmbrdf.pythonic_disort_modes(PTFE, 532, streams=4))
    assert "4 of the model's 14 moments" in said and "10 are left out" in said
    for enough in [{"streams": 14}, {"streams": 4, "moments": 3}]:  # the second asks for it
        assert not warned(UserWarning, lambda: mmbrdf.pythonic_disort_modes(PTFE, 532, **enough))


def test_a_model_that_is_not_its_own_mirror_image_is_refused_where_it_has_no_place(tmp_path):
    lines = ["1, 1, 0, 0, 0, 0, 0, 0.3", "1, 2, 0, 2, 0, -2, 0, 0.3", "1, 3, 0, 2, 0, 2, 0, -0.2"]
    (tmp_path / "handed.csv").write_text("\n".join(lines) + "\n")
    handed = mmbrdf.load(tmp_path / "handed.csv")
    assert len(mmbrdf.pythonic_disort_modes(handed, 532, streams=8)) == 5  # f11 has no sides
    with pytest.raises(ValueError, match="channel = 'f_ss': the model is not its own mirror image"):
        mmbrdf.pythonic_disort_modes(handed, 532, streams=8, channel="f_ss")
    with pytest.raises(ValueError, match="a sample that is its own mirror image"):
        handed.export(tmp_path / "x.vlidort", wavelength_nm=532, streams=4, sun_deg=30)
    assert not (tmp_path / "x.vlidort").exists()


def test_functions_for_pythonic_disort_are_moments_about_the_forward_direction():
    modes = mmbrdf.pythonic_disort_modes(PTFE, 532, streams=16)
    assert len(modes) == 14
    mu, mu_p = np.array([0.2, 0.5, 0.9]), np.array([0.3, 0.8])
    assert all(mode(mu, mu_p).shape == (3, 2) for mode in modes)
    theta_i, theta_r = np.degrees(np.arccos(mu_p)), np.degrees(np.arccos(mu))[:, None]
    for from_forward in [0, 40, 180]:
        total = sum(mode(mu, mu_p) * np.cos(m * np.radians(from_forward)) for m, mode in enumerate(modes))
        expected = PTFE.evaluate(532, theta_i, 0, theta_r, 180 + from_forward, frame="sp")
        np.testing.assert_allclose(total, np.pi * expected[..., 0, 0], rtol=1e-12)
    for channel in ["f_ss", "f_sp", "f_ps", "f_pp"]:
        of_channel = mmbrdf.pythonic_disort_modes(PTFE, 532, streams=16, channel=channel)
        total = sum(mode(mu, mu_p) for mode in of_channel)
        expected = getattr(mmbrdf, channel)(PTFE.evaluate(532, theta_i, 0, theta_r, 180, frame="sp"))
        np.testing.assert_allclose(total, np.pi * expected, rtol=1e-11)


def test_more_moments_than_the_quadrature_carries_are_refused():
    with pytest.warns(UserWarning, match="8 of the model's 14 moments"):
        assert len(mmbrdf.pythonic_disort_modes(PTFE, 532, streams=8)) == 8
    assert len(mmbrdf.pythonic_disort_modes(PTFE, 532, streams=32, moments=3)) == 3
    with pytest.raises(ValueError, match="9 moments: a quadrature of 8 streams"):
        mmbrdf.pythonic_disort_modes(PTFE, 532, streams=8, moments=9)
    with pytest.raises(ValueError, match="must be even"):
        mmbrdf.pythonic_disort_modes(PTFE, 532, streams=7)
    with pytest.raises(ValueError, match="channel = 'f_xy'"):
        mmbrdf.pythonic_disort_modes(PTFE, 532, streams=8, channel="f_xy")


def test_the_surface_for_py6s_has_a_row_for_each_azimuth():
    surface = mmbrdf.py6s_surface(PTFE, 532, sun_deg=30, view_deg=50, azimuth_deg=40)
    zenith, azimuth = np.array([0, 10, 20, 30, 40, 50, 60, 70, 80, 85]), np.arange(0, 361, 30)[:, None]
    for name, sun, scene in [("ro_sun_at_thetas", 30, 40), ("ro_sun_at_thetav", 50, -40)]:
        assert surface[name].shape == (13, 10)
        expected = np.pi * PTFE.evaluate(532, sun, 0, zenith, scene + azimuth)[..., 0, 0]
        np.testing.assert_allclose(surface[name], expected, atol=1e-7)
    assert surface["albedo"] == pytest.approx(mmbrdf.bihemispherical_reflectance(PTFE, 532), abs=1e-7)
    assert surface["observed_reflectance"] == pytest.approx(np.pi * PTFE.evaluate(532, 30, 0, 50, 40)[0, 0], abs=1e-7)


def dataset(path):
    """As xarray reads it, without the file behind it."""
    xarray = pytest.importorskip("xarray", reason="no xarray: ./dev packages python")
    pytest.importorskip("netCDF4", reason="no netCDF4: ./dev packages python")
    with xarray.open_dataset(path) as opened:
        return opened.load()


def test_netcdf_is_the_model_with_names_for_all_that_it_means(tmp_path):
    path = tmp_path / "plaque.nc"
    written = PTFE.export(path, wavelength_nm=[532, 600], error=0.01)
    assert "steps of 10, phi_i = 0, frame sp" in written
    data = dataset(path)
    f = data["brdf"]
    assert f.dims == ("wavelength_nm", "theta_i_deg", "theta_r_deg", "phi_r_deg", "row", "column")
    assert f.dtype == np.float64
    assert f.attrs["units"] == "sr-1" and f.attrs["frame"] == "sp" and f.attrs["convention"].startswith("germer2017:")
    assert data.attrs["fitted_range"].startswith("theta_i <= 75") and "data" in data.attrs["provenance"]
    expected = PTFE.evaluate(532, 40, 0, 60, 150, frame="sp")
    at = {"wavelength_nm": 532, "theta_i_deg": 40, "theta_r_deg": 60, "phi_r_deg": 150}
    np.testing.assert_allclose(f.sel(at), expected, rtol=1e-12)
    assert float(f.sel(at).sel(row=1, column=2)) == pytest.approx(expected[0, 1], rel=1e-12)
    u = PTFE.evaluate_uncertainty(532, 40, 0, 60, 150, frame="sp")
    np.testing.assert_allclose(data["uncertainty"].sel(at), u, rtol=1e-9)
    assert int(data["validity"].sel(at)) == 0
    assert int(data["validity"].sel(at | {"theta_i_deg": 80})) == int(mmbrdf.Outside.THETA_I)
    assert int(data["validity"].sel(at | {"wavelength_nm": 600})) == int(mmbrdf.Outside.INTERPOLATED)
    assert np.isfinite(f).all()


def test_netcdf_interpolated_by_xarray_has_the_error_that_it_says(tmp_path):
    xarray = pytest.importorskip("xarray")
    model = mmbrdf.material("ptfe-532")
    written = model.export(tmp_path / "plaque.nc")
    stated = float(written.split("interpolation adds ")[1].split(" %")[0]) / 100
    f = dataset(tmp_path / "plaque.nc")["brdf"][0]
    ti, pi, tr, pr = mmbrdf.random_geometries(2000, seed=5)
    asked = {
        "theta_i_deg": xarray.DataArray(ti, dims="n"),
        "theta_r_deg": xarray.DataArray(tr, dims="n"),
        "phi_r_deg": xarray.DataArray((pr - pi) % 360, dims="n"),
    }
    expected = model.evaluate(532, ti, pi, tr, pr, frame="sp")
    part = (f.interp(asked).transpose("n", "row", "column").values - expected) / expected[:, :1, :1]
    assert stated <= 5e-4
    assert np.sqrt((part**2).mean()) == pytest.approx(stated, rel=0.3)


def test_mqdiffuse_is_even_in_cosines_and_azimuths_without_the_end_of_the_circle(tmp_path):
    path = tmp_path / "plaque.nc"
    written = PTFE.export(path, "mqdiffuse", wavelength_nm=532, error=5e-3)
    data = dataset(path)
    assert data.attrs["title"] == "f11 of ptfe at 532 nm, for mqdiffuse of eradiate"
    assert data.attrs["fitted_range"].startswith("theta_i <= 75, theta_r <= 81.87 degrees at 351,")
    f = data["brdf"]
    assert f.dims == ("cos_theta_o", "phi_d", "cos_theta_i") and f.attrs["units"] == "sr-1"
    for name in ["cos_theta_o", "cos_theta_i"]:
        assert data[name].attrs["units"] == "1"
        np.testing.assert_allclose(data[name], np.linspace(0, 1, data.sizes[name]))
    assert data["phi_d"].attrs["units"] == "rad"
    np.testing.assert_allclose(data["phi_d"], np.linspace(0, 2 * np.pi, data.sizes["phi_d"], endpoint=False))
    o, d, i = (
        np.degrees(np.arccos(data["cos_theta_o"])),
        np.degrees(data["phi_d"]),
        np.degrees(np.arccos(data["cos_theta_i"])),
    )
    expected = PTFE.evaluate(532, i.values, 0, o.values[:, None, None], d.values[:, None])[..., 0, 0]
    np.testing.assert_allclose(f, expected, atol=1e-12)
    assert "pi is forward" in written and "interpolation adds" in written


FORTRAN = """
program read_surface
  implicit none
  integer :: u, i, lines, nstokes, nstreams, nmoments, nsuns, nviews, nazimuths
  character(200) :: text
  real(8), allocatable :: mu(:), w(:), sun(:), view(:), azm(:)
  real(8), allocatable :: f_0(:,:,:,:), f(:,:,:,:), exact(:,:,:,:), user_f_0(:,:,:,:), user_f(:,:,:,:)
  open (newunit=u, file='plaque.vlidort', status='old')
  read (u, *) lines, nstokes, nstreams, nmoments, nsuns, nviews, nazimuths
  do i = 1, lines
    read (u, '(a)') text
  end do
  allocate (mu(nstreams), w(nstreams), sun(nsuns), view(nviews), azm(nazimuths))
  allocate (f_0(0:nmoments-1, 16, nstreams, nsuns), f(0:nmoments-1, 16, nstreams, nstreams))
  allocate (exact(16, nviews, nazimuths, nsuns))
  allocate (user_f_0(0:nmoments-1, 16, nviews, nsuns), user_f(0:nmoments-1, 16, nviews, nstreams))
  do i = 1, nstreams
    read (u, *) mu(i), w(i)
  end do
  read (u, *) sun, view, azm
  read (u, *) f_0, f, exact, user_f_0, user_f
  print '(3es20.11)', 2 * sum(w * mu * f_0(0, 1, :, 2)), exact(2, 1, 3, 2), user_f(1, 1, 2, 3)
end program
"""


def test_fortran_reads_the_surface_for_vlidort_in_one_statement(tmp_path):
    if not shutil.which("gfortran"):
        pytest.skip("no gfortran: ./dev packages fortran")
    PTFE.export(
        tmp_path / "plaque.vlidort",
        wavelength_nm=532,
        streams=8,
        sun_deg=[30, 60],
        view_deg=[10, 70],
        azimuth_deg=[180, 90, 20],
    )
    (tmp_path / "read.f90").write_text(FORTRAN)
    subprocess.run(["gfortran", "-o", "read", "read.f90"], cwd=tmp_path, check=True)
    found = [float(x) for x in subprocess.check_output("./read", cwd=tmp_path, text=True).split()]
    assert found[0] == pytest.approx(mmbrdf.directional_hemispherical_reflectance(PTFE, 532, 60), abs=1e-8)
    assert found[1] == pytest.approx(-np.pi * PTFE.evaluate(532, 60, 0, 10, 20, frame="sp")[0, 1], abs=1e-9)
    cosine, _ = PTFE.fourier_moments(532, (np.polynomial.legendre.leggauss(8)[0][2] + 1) / 2, np.cos(np.radians(70)))
    assert found[2] == pytest.approx(-np.pi * cosine[0, 0, 1, 0, 0], abs=1e-9)
