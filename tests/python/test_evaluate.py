# SPDX-License-Identifier: BSD-3-Clause
"""Evaluation over arrays: laws of broadcasting, and the same bits as the program."""

import concurrent.futures
import csv
import io
import json
import warnings

import numpy as np
import pytest

import mmbrdf

ARGUMENTS = ("wavelength_nm", "theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg")


def one_by_one(model, *arguments, **options):
    """The same by a loop over single numbers."""
    arrays = np.broadcast_arrays(*arguments)
    flat = [model.evaluate(*map(float, question), **options) for question in zip(*(a.ravel() for a in arrays))]
    return np.array(flat).reshape(*arrays[0].shape, 4, 4)


def test_a_single_geometry_gives_one_matrix(ptfe):
    f = ptfe.evaluate(wavelength_nm=532, theta_i_deg=45, phi_i_deg=0, theta_r_deg=30, phi_r_deg=180)
    assert f.shape == (4, 4) and f.dtype == np.float64
    assert f[0, 0] == pytest.approx(0.3282394121, abs=5e-11)  # README


@pytest.mark.parametrize("frame", ["xy", "sp", "scattering_plane"])
def test_arrays_broadcast_as_numpy_does(ptfe, frame):
    arguments = (np.array([[[351.0]], [[532.0]]]), 45, [[0.0], [10.0], [200.0]], np.linspace(-70, 70, 5), 180)
    f = ptfe.evaluate(*arguments, frame=frame)
    assert f.shape == (2, 3, 5, 4, 4)
    np.testing.assert_array_equal(f, one_by_one(ptfe, *arguments, frame=frame))


def test_wavelengths_may_vary_fastest(ptfe):
    arguments = (np.linspace(351, 1064, 7), 30, 0, [[20.0], [40.0]], 180)
    np.testing.assert_array_equal(ptfe.evaluate(*arguments), one_by_one(ptfe, *arguments))


def test_each_row_may_have_a_wavelength_of_its_own(ptfe):
    arguments = (np.linspace(351, 1064, 1301), np.linspace(0, 75, 1301), 0, np.linspace(75, 0, 1301), 180)
    np.testing.assert_array_equal(ptfe.evaluate(*arguments, threads=2), one_by_one(ptfe, *arguments))


def test_strides_and_types_do_not_matter(ptfe):
    theta = np.arange(0, 80, 5)
    expected = ptfe.evaluate(532, 45, 0, theta.astype(float), 180)
    unaligned = np.frombuffer(b"x" + theta.astype(float).tobytes(), dtype=float, offset=1)
    structured = np.zeros(len(theta), dtype=[("name", "S3"), ("theta", float)])
    structured["theta"] = theta
    read_only = theta.astype(float)
    read_only.setflags(write=False)
    for same in (
        theta,
        theta.astype(np.float32),
        theta.astype(np.uint8),
        theta.astype(">f8"),
        np.repeat(theta, 3)[::3],
        np.ascontiguousarray(theta[::-1])[::-1],
        unaligned,
        structured["theta"],
        read_only,
        np.ma.masked_array(theta, mask=False),
        list(theta),
        range(0, 80, 5),
    ):
        np.testing.assert_array_equal(ptfe.evaluate(532, 45, 0, same, 180), expected)
    grid = np.arange(12.0).reshape(3, 4)
    np.testing.assert_array_equal(ptfe.evaluate(532, 45, 0, grid.T, 180), ptfe.evaluate(532, 45, 0, grid.T.copy(), 180))
    np.testing.assert_array_equal(ptfe.evaluate(532, True, 0, 30, 180), ptfe.evaluate(532, 1, 0, 30, 180))


@pytest.mark.parametrize(
    "wrong",
    [None, 30 + 0j, "30", b"30", np.timedelta64(30), np.array([30, None]), [[1], [2, 3]], np.zeros(2, dtype="f8,f8")],
)
def test_what_is_no_real_number_is_refused_by_name(ptfe, wrong):
    with pytest.raises(TypeError, match="^theta_r_deg: [^\n]*$"):
        ptfe.evaluate(532, 45, 0, wrong, 180)


def test_masked_numbers_are_refused_not_used(ptfe, samples):
    with pytest.raises(ValueError, match="theta_r_deg: a part of it is masked"):
        ptfe.evaluate(532, 45, 0, np.ma.masked_array([30.0, 40.0], mask=[False, True]), 180)
    for within in ([np.ma.masked, 30.0], ((30.0, 40.0), [20.0, np.ma.masked]), [[np.ma.masked_array([3, 4], [0, 1])]]):
        with pytest.raises(ValueError, match="^theta_r_deg: a part of it is masked; leave it out$"):
            ptfe.evaluate(532, 45, 0, within, 180)
    np.testing.assert_array_equal(
        ptfe.evaluate(532, 45, 0, [np.ma.masked_array([30.0, 40.0])], 180), ptfe.evaluate(532, 45, 0, [[30, 40]], 180)
    )
    bright = np.ma.masked_array(samples.f11 > 0.3, np.arange(len(samples)) % 2)
    for which in (bright, list(bright[:3]), np.ma.masked_array([0, 1], [False, True])):
        with pytest.raises(ValueError, match="^which: a part of it is masked; leave it out$"):
            samples[which]
    assert len(samples[bright.filled(False)]) == np.count_nonzero(samples.f11[::2] > 0.3)
    endless = []
    endless.append(endless)
    with pytest.raises((TypeError, ValueError)):
        ptfe.evaluate(532, 45, 0, endless, 180)


def test_arguments_are_left_as_they_were(ptfe):
    angles = np.array([-30.0, 30.0])
    ptfe.evaluate(532, angles, 0, angles, 180)
    np.testing.assert_array_equal(angles, [-30, 30])


@pytest.mark.parametrize("shape", [(0,), (3, 0), (0, 2)])
def test_no_geometries_give_no_matrices(ptfe, shape):
    nothing = np.empty(shape)
    assert ptfe.evaluate(532, nothing, 0, 30, 180).shape == (*shape, 4, 4)
    assert ptfe.evaluate_uncertainty(532, nothing, 0, 30, 180).shape == (*shape, 4, 4)
    assert ptfe.outside(532, nothing, 0, 30, 180).shape == shape


@pytest.mark.parametrize("name", ARGUMENTS)
def test_shapes_that_do_not_broadcast_are_named(ptfe, name):
    arguments = dict.fromkeys(ARGUMENTS, 30.0) | {"wavelength_nm": 532.0, "theta_i_deg": [10, 20, 30]}
    other = "theta_r_deg" if name == "theta_i_deg" else name
    arguments[other] = [532.0, 532.0] if other == "wavelength_nm" else [10, 20]
    with pytest.raises(ValueError, match=r"do not broadcast: .*theta_i_deg \(3,\)"):
        ptfe.evaluate(**arguments)


def test_invalid_angles_are_named_with_their_place(ptfe):
    angles = np.full((2, 3), 30.0)
    angles[1, 2] = 95
    with pytest.raises(ValueError, match=r"95,0.*\[-90, 90\].*\[1, 2\]"):
        ptfe.evaluate(532, angles, 0, 30, 180)
    with pytest.raises(ValueError, match=r"phi_r_deg is not finite, at \[0\]"):
        ptfe.evaluate(532, 30, 0, 30, [np.nan, 0])
    with pytest.raises(ValueError, match=r"wavelength 1e\+10 nm is more than a metre, at \[0, 1\]"):
        ptfe.evaluate([[532, 1e10]], [[30], [40]], 0, 30, 180)
    with pytest.raises(ValueError, match="1e\\+10 nm is more than a metre"):
        ptfe.outside(1e10, 30, 0, 30, 180)
    with pytest.raises(ValueError, match=r"wavelength_nm = -1.*at \[1\]"):
        ptfe.evaluate([532, -1], 30, 0, 30, 0)


def test_other_invalid_arguments_are_refused(ptfe):
    for wavelength in (0, -532, np.nan, np.inf):
        with pytest.raises(ValueError, match="wavelength"):
            ptfe.evaluate(wavelength, 45, 0, 30, 180)
    with pytest.raises(ValueError, match="351, 532, 633, 1064"):
        ptfe.evaluate(None, 45, 0, 30, 180)
    with pytest.raises(ValueError, match="frame 'stokes' is not one of xy, sp, scattering_plane"):
        ptfe.evaluate(532, 45, 0, 30, 180, frame="stokes")
    for threads in (-1, 5000):
        with pytest.raises(ValueError, match=f"threads = {threads}"):
            ptfe.evaluate(532, 45, 0, 30, 180, threads=threads)
    with pytest.raises(TypeError):
        ptfe.evaluate(532, 45, 0, 30)


def test_a_model_of_one_wavelength_needs_none():
    model = mmbrdf.material("ptfe-532")
    np.testing.assert_array_equal(
        model.evaluate(theta_i_deg=45, phi_i_deg=0, theta_r_deg=30, phi_r_deg=180), model.evaluate(532, 45, 0, 30, 180)
    )


def test_the_result_may_go_into_an_array_that_is_there(ptfe):
    theta = np.array([[10.0, 20.0, 30.0], [40.0, 50.0, 60.0]])
    room = np.full((2, 3, 4, 4), np.nan)
    result = ptfe.evaluate(532, 45, 0, theta, 180, out=room)
    assert np.shares_memory(result, room)
    np.testing.assert_array_equal(room, ptfe.evaluate(532, 45, 0, theta, 180))
    read_only = np.zeros((2, 3, 4, 4))
    read_only.setflags(write=False)
    for wrong in (
        np.zeros((3, 2, 4, 4)),
        np.zeros((2, 3, 16)),
        np.zeros((2, 3, 4, 4), dtype=np.float32),
        np.zeros((2, 3, 4, 4), order="F"),
        np.zeros((2, 3, 4, 8))[..., ::2],
        read_only,
    ):
        with pytest.raises(ValueError, match="out: must be"):
            ptfe.evaluate(532, 45, 0, theta, 180, out=wrong)
    memory = np.zeros(96)
    with pytest.raises(ValueError, match="out: shares memory"):
        ptfe.evaluate(532, 45, 0, memory[:6].reshape(2, 3), 180, out=memory.reshape(2, 3, 4, 4))


def test_every_number_of_threads_gives_the_same_bits(ptfe):
    geometry = mmbrdf.random_geometries(20000, seed=3)
    for wavelengths in (532, np.linspace(351, 1064, 20000)):
        one = ptfe.evaluate(wavelengths, *geometry, threads=1)
        for threads in (None, 0, 2, 3, 7):
            np.testing.assert_array_equal(ptfe.evaluate(wavelengths, *geometry, threads=threads), one)


def test_an_error_in_any_thread_is_the_first_in_the_array(ptfe):
    theta = np.full(20000, 30.0)
    theta[[7000, 19999]] = 95
    for threads in (1, 2, 5):
        with pytest.raises(ValueError, match=r"at \[7000\]"):
            ptfe.evaluate(532, theta, 0, 30, 180, threads=threads)


def test_several_threads_of_python_may_evaluate_at_once(ptfe):
    geometry = mmbrdf.random_geometries(5000, seed=3)
    expected = ptfe.evaluate(532, *geometry)
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        for f in pool.map(lambda _: mmbrdf.material("ptfe").evaluate(532, *geometry), range(8)):
            np.testing.assert_array_equal(f, expected)


def test_extrapolation_is_said_and_found(ptfe):
    with pytest.warns(
        mmbrdf.ExtrapolationWarning, match=r"ptfe: 2 of 3 questions lie outside .*\(theta_i\): fitted are theta_i <= 75"
    ):
        ptfe.evaluate(532, [30, 80, 85], 0, 30, 180)
    with pytest.warns(mmbrdf.ExtrapolationWarning, match="wavelength"):
        ptfe.evaluate([532, 1500], 30, 0, 30, 180)
    with pytest.warns(mmbrdf.ExtrapolationWarning, match="3 of 4 questions"):
        ptfe.evaluate([[532, 1500]], [[30], [80]], 0, 30, 180)
    outside = ptfe.outside([532, 1500], [[30], [80]], 0, 85, 180)
    flags = mmbrdf.Outside
    assert outside.dtype == np.uint8
    assert flags(int(outside[0, 0])) == flags.THETA_R
    assert flags(int(outside[1, 1])) == flags.THETA_I | flags.THETA_R | flags.WAVELENGTH
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ptfe.evaluate(532, 45, 0, 81, 180)
        for question in (
            lambda: ptfe.evaluate(532, 80, 0, 30, 180),
            lambda: ptfe.evaluate_uncertainty(532, 80, 0, 30, 180),
            lambda: ptfe.evaluate_draws(2, 1, 532, 80, 0, 30, 180),
            lambda: mmbrdf.directional_hemispherical_reflectance(ptfe, 2000),
            lambda: mmbrdf.directional_hemispherical_reflectance(ptfe, 532, 80),
            lambda: mmbrdf.bihemispherical_reflectance(ptfe, 2000),
            lambda: mmbrdf.polarized_curve(ptfe, 532, mmbrdf.in_plane(45, [85])),
            lambda: mmbrdf.average(ptfe, 532, mmbrdf.Aperture.direction(80), mmbrdf.Aperture.direction(0)),
        ):
            with pytest.raises(mmbrdf.ExtrapolationWarning):
                question()


@pytest.mark.parametrize(("name", "as_printed"), [("ptfe", False), ("published", False), ("published", True)])
def test_the_program_gives_the_same_bits(name, as_printed, program, tmp_path):
    model = mmbrdf.material("ptfe")
    if name == "published":
        model = mmbrdf.in_published_form(model)
        name = tmp_path / "published.json"
        model.save(name)
    random = np.random.default_rng(5)
    rows = np.column_stack(
        [random.uniform(351, 1064, 200), random.uniform(-75, 75, 200), random.uniform(-180, 360, 200),
         random.uniform(-75, 75, 200), random.uniform(-180, 360, 200)]
    )  # fmt: skip
    text = ",".join(ARGUMENTS) + "\n" + "\n".join(",".join(map(repr, map(float, row))) for row in rows)
    (tmp_path / "where.csv").write_text(text)
    for frame in ("xy", "sp", "scattering_plane"):
        printed = program(
            "evaluate", name, "--geometries", "where.csv", "--frame", frame, *(["--as-printed"] if as_printed else [])
        )
        there = [
            [float(row[f"f{i}{j}"]) for i in range(1, 5) for j in range(1, 5)]
            for row in csv.DictReader(io.StringIO(printed))
        ]
        here = model.evaluate(*rows.T, frame=frame, as_printed=as_printed)
        np.testing.assert_array_equal(here.reshape(-1, 16), there)


def test_published_coefficients_can_be_evaluated_as_printed(published):
    model = mmbrdf.load(published / "PTFE.532.coeff.csv")
    at_zero = (532, 45, 0, 30, 150)
    np.testing.assert_allclose(model.evaluate(*at_zero, as_printed=True), model.evaluate(*at_zero), rtol=0, atol=1e-15)
    turned = (532, 45, 70, 30, 220)
    assert np.abs(model.evaluate(*turned, as_printed=True) - model.evaluate(*turned)).max() > 1e-4


def test_uncertainties_are_the_roots_of_the_covariance(ptfe):
    question = (532, 45, 0, np.linspace(-60, 60, 9), 180)
    for frame in ("xy", "sp"):
        u = ptfe.evaluate_uncertainty(*question, frame=frame)
        v = ptfe.covariance(*question, frame=frame)
        assert u.shape == (9, 4, 4) and v.shape == (9, 16, 16)
        np.testing.assert_allclose(u.reshape(9, 16) ** 2, np.diagonal(v, axis1=1, axis2=2), rtol=1e-12, atol=1e-30)
        np.testing.assert_allclose(v, np.swapaxes(v, 1, 2), rtol=1e-14, atol=1e-30)
        assert (u[:, 0, 0] > 1e-4).all()


def test_the_program_gives_the_same_uncertainties(ptfe, program):
    terms = {"scale": 0.003, "theta_i_deg": 0.02, "theta_r_deg": 0.03, "azimuth_deg": 0.05, "calibration": 0.001}
    arguments = [
        part
        for name, value in terms.items()
        for part in ("--term", f"{name.removesuffix('_deg')}={value}" + ("deg" if name.endswith("_deg") else ""))
    ]
    printed = json.loads(
        program("analyze", "ptfe", "-w", 532, "-i", "45,0", "-r", "30,180", "--format", "json", *arguments)
    )
    u = ptfe.evaluate_uncertainty(532, 45, 0, 30, 180, terms=terms)
    np.testing.assert_allclose(u, printed["u_mueller"], rtol=1e-12, atol=1e-18)


def test_terms_of_type_b_add_to_the_uncertainty(ptfe):
    question = (532, 45, 0, 30, 180)
    f, fit = ptfe.evaluate(*question), ptfe.evaluate_uncertainty(*question)
    scaled = ptfe.evaluate_uncertainty(*question, terms={"scale": 0.003})
    np.testing.assert_allclose(scaled**2, fit**2 + (0.003 * f) ** 2, rtol=1e-12, atol=1e-30)  # of 0, rounding
    assert (ptfe.evaluate_uncertainty(*question, terms={"theta_r_deg": 0.1})[0, 0]) > fit[0, 0]
    for wrong in ({"theta_r": 0.1}, {"scale_deg": 0.1}, {"weather": 1}, {"scale": -1}):
        with pytest.raises(ValueError):
            ptfe.evaluate_uncertainty(*question, terms=wrong)


@pytest.mark.parametrize("term", ["scale", "theta_i_deg", "theta_r_deg", "azimuth_deg", "calibration"])
def test_a_term_that_is_no_number_is_refused(term, ptfe):
    with pytest.raises(ValueError, match=f"uncertainty nan of {term}, must be in"):
        ptfe.evaluate_uncertainty(532, 45, 0, 30, 180, terms={term: np.nan})


def test_draws_scatter_as_the_covariance_says(ptfe):
    question = (532, 45, 0, [20, 40], 180)
    draws = ptfe.evaluate_draws(2000, 1, *question)
    assert draws.shape == (2000, 2, 4, 4)
    ratio = draws.std(axis=0)[:, 0, 0] / ptfe.evaluate_uncertainty(*question)[:, 0, 0]
    np.testing.assert_allclose(ratio, 1, atol=0.08)  # 5 standard deviations of that of 2000 draws
    np.testing.assert_array_equal(draws[:100], ptfe.evaluate_draws(100, 1, *question)[:100])


def test_a_sampling_of_the_whole_sphere_is_estimable(ptfe):
    assert ptfe.estimable(532, [30, 60], 0, 45, [[90], [180]]).all()


def test_nothing_is_estimable_beyond_the_fitted_angles(anisotropic):
    i, r = anisotropic.theta_i_max_deg, anisotropic.theta_r_max_deg
    where = [i - 1, i + 1, 45, 45], 0, [45, 45, r - 1, r + 1], 90
    assert anisotropic.estimable(532, *where).tolist() == [True, False, True, False]


def test_models_without_covariance_have_no_uncertainty(published):
    model = mmbrdf.load(published / "PTFE.532.coeff.csv")
    assert not model.has_covariance
    with pytest.raises(ValueError, match="covariance"):
        model.evaluate_uncertainty(532, 45, 0, 30, 180)


def test_results_with_names_go_to_netcdf_and_back(ptfe, tmp_path):
    xarray = pytest.importorskip("xarray")
    theta = np.arange(-60.0, 61, 20)
    named = ptfe.evaluate([[532], [633]], 45, 0, theta, 180, frame="sp", as_xarray=True)
    assert named.dims == ("wavelength_nm", "theta_r_deg", "row", "column")
    np.testing.assert_array_equal(named.values, ptfe.evaluate([[532], [633]], 45, 0, theta, 180, frame="sp"))
    assert named.attrs["units"] == "sr-1" and named.attrs["frame"] == "sp"
    assert named.theta_r_deg.attrs["units"] == "degree"
    f11 = float(named.sel(wavelength_nm=633, theta_r_deg=20, row=1, column=1))
    assert f11 == ptfe.evaluate(633, 45, 0, 20, 180)[0, 0]
    named.to_netcdf(tmp_path / "brdf.nc")
    with xarray.open_dataarray(tmp_path / "brdf.nc") as back:
        assert back.identical(named)


def test_geometries_that_vary_together_share_an_axis(ptfe):
    named = ptfe.evaluate_uncertainty(532, [10, 20, 30], 0, [30, 20, 10], 180, as_xarray=True)
    assert named.dims == ("axis_0", "row", "column")
    np.testing.assert_array_equal(named.theta_i_deg, [10, 20, 30])
    np.testing.assert_array_equal(named.theta_r_deg, [30, 20, 10])
    assert named.name == "uncertainty"
    with_terms = ptfe.evaluate_uncertainty(532, 10, 0, 30, 180, terms={"scale": 0.003}, as_xarray=True)
    assert json.loads(with_terms.attrs["terms"]) == {"scale": 0.003}


def test_a_model_that_does_not_say_where_it_was_fitted_is_warned_of_once(tmp_path):
    (tmp_path / "published.csv").write_text("1, 1, 0, 0, 0, 0, 0, 0.3\n")
    model = mmbrdf.load(tmp_path / "published.csv")
    with pytest.warns(mmbrdf.ExtrapolationWarning, match="does not say to which wavelengths and angles it was fitted"):
        model.evaluate(2500, 89, 0, 89, 180)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        model.evaluate(2500, 89, 0, 89, 180)
