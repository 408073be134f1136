# SPDX-License-Identifier: BSD-3-Clause
"""What is in the pictures of mmbrdf.plot: the numbers that artists hold, limits, labels, and what is left out."""
import subprocess
import sys
import warnings

import numpy as np
import pytest
from matplotlib.collections import PathCollection, PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Circle

import mmbrdf
import mmbrdf.plot
from mmbrdf.plot import curves, disc
from pictures import SAMPLES, rendered, written


def evaluated(model, *arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mmbrdf.ExtrapolationWarning)
        return model.evaluate(*arguments, **options)


def cell_centres(samples=SAMPLES):
    """x and y, by row and column, of a picture whose lowest row comes first."""
    return np.meshgrid(*[-1 + (np.arange(samples) + 0.5) * 2 / samples] * 2)


def expected_over_disc(model, wavelength_nm, theta_i_deg, frame="xy", samples=SAMPLES):
    """Where the disc is, and the Mueller matrices there, evaluated one row of directions at a time."""
    x, y = cell_centres(samples)
    inside = np.hypot(x, y) < 1
    theta_r_deg = np.degrees(np.arcsin(np.hypot(x, y)[inside]))
    phi_r_deg = np.degrees(np.arctan2(y, x)[inside])
    return inside, evaluated(model, wavelength_nm, theta_i_deg, 180.0, theta_r_deg, phi_r_deg, frame=frame)


def picture(axes):
    (image,) = axes.images
    return image.get_array()


# The 4 x 4 hemisphere


@pytest.mark.parametrize("frame", ["xy", "sp"])
def test_the_hemisphere_shows_the_models_values_and_nothing_outside_the_disc(ptfe, frame):
    figure, axes = mmbrdf.plot.hemisphere(ptfe, 532, 60, samples=SAMPLES, frame=frame)
    inside, mueller = expected_over_disc(ptfe, 532, 60, frame)
    for row, column in np.ndindex(4, 4):
        shown = picture(axes[row, column])
        assert np.array_equal(np.ma.getmaskarray(shown), ~inside)
        expected = mueller[:, row, column] / (1 if row == column == 0 else mueller[:, 0, 0])
        np.testing.assert_array_equal(shown[inside].data, expected)
    assert len(np.unique(rendered(figure).reshape(-1, 4), axis=0)) > 100


def test_the_hemisphere_has_the_papers_scales_and_colours(ptfe):
    figure, axes = mmbrdf.plot.hemisphere(ptfe, 532, 60, samples=SAMPLES, scale="paper")
    images = [each.images[0] for each in axes.flat]
    assert images[0].get_clim() == (0.25, 0.45)
    assert all(image.get_clim() == (-0.1, 0.1) for image in images[1:])
    assert images[0].cmap(0.0)[:3] == (0, 0, 0) and images[0].cmap(1.0)[:3] == (1, 1, 1)
    red, _, blue, _ = images[1].cmap(0.0)
    assert blue > 2 * red
    red, _, blue, _ = images[1].cmap(1.0)
    assert red > 2 * blue
    assert min(images[1].cmap(0.5)[:3]) > 0.95


def test_the_hemisphere_names_elements_units_wavelength_and_angle(ptfe):
    figure, _ = mmbrdf.plot.hemisphere(ptfe, 532, 60, samples=SAMPLES)
    text = written(figure)
    for expected in ("11", "34", "44", "sr$^{-1}$", "532 nm", "60°", r"\sin\theta", "ptfe"):
        assert expected in text
    figure, _ = mmbrdf.plot.hemisphere(ptfe, 532, 60, samples=SAMPLES, title="a plaque")
    assert "a plaque" in written(figure) and "532 nm" not in written(figure)


def test_forward_scattering_is_on_the_right(ptfe):
    _, axes = mmbrdf.plot.hemisphere(ptfe, 532, 60, samples=SAMPLES)
    f11 = picture(axes[0, 0])
    forward = evaluated(ptfe, 532, 60, 180, np.degrees(np.arcsin(18 / 21)), 0)[0, 0]
    assert f11[SAMPLES // 2, 19] == pytest.approx(forward, rel=1e-12)
    assert f11[SAMPLES // 2, 19] > f11[SAMPLES // 2, 1]


def test_samples_are_cells_of_the_grid_of_direction_cosines(data):
    figure, axes = mmbrdf.plot.hemisphere(data, 532, 30)
    image = axes[1, 1].images[0]
    assert image.get_array().shape == (19, 19)
    np.testing.assert_allclose(image.get_extent(), (-0.95, 0.95, -0.95, 0.95), atol=1e-5)
    chosen = data[np.isclose(data.theta_i_deg, 30, atol=0.01)]
    x, y = (
        np.sin(np.radians(chosen.theta_r_deg)) * function(np.radians(chosen.phi_r_deg)) for function in (np.cos, np.sin)
    )
    columns, rows = np.rint(10 * x).astype(int) + 9, np.rint(10 * y).astype(int) + 9
    shown = image.get_array()
    np.testing.assert_array_equal(shown[rows, columns].data, chosen.normalized[:, 1, 1])
    assert (~np.ma.getmaskarray(shown)).sum() == len(chosen) == 304
    assert "measured" in written(figure)


def test_samples_are_turned_into_the_frame_asked_for(ptfe, data):
    _, axes = mmbrdf.plot.hemisphere(data, 532, 60, frame="sp")
    cosine = 0.3  # of the sample at x = y = 0.3
    theta_r_deg = np.degrees(np.arcsin(np.hypot(cosine, cosine)))
    mueller = evaluated(ptfe, 532, 60, 180, theta_r_deg, 45, frame="sp")
    for row, column in ((1, 1), (1, 2), (2, 3)):
        assert picture(axes[row, column])[9 + 3, 9 + 3] == pytest.approx(mueller[row, column] / mueller[0, 0], abs=1e-6)


def test_the_cell_that_the_receiver_blocks_is_left_out(data):
    _, axes = mmbrdf.plot.hemisphere(data, 532, 30)
    # The source at theta_i = 30, phi_i = 180 is at x = -0.5, y = 0.
    assert np.ma.getmaskarray(picture(axes[0, 0]))[9, 9 - 5]


def test_samples_at_normal_incidence_are_found_whatever_their_azimuth(ptfe):
    geometry = mmbrdf.germer2017_grid()
    normal = np.asarray(geometry.theta_i_deg) < 0.01
    turned = [np.asarray(angle)[normal] for angle in geometry]
    turned[1] = np.full(normal.sum(), 37.0)
    _, axes = mmbrdf.plot.hemisphere(mmbrdf.simulate(ptfe, 532, mmbrdf.Geometry(*turned)), 532, 0)
    assert picture(axes[0, 0]).count() == 304


def test_samples_off_a_grid_are_shown_around_their_directions(ptfe):
    theta_r_deg, phi_r_deg = (a.ravel() for a in np.meshgrid(np.arange(10.0, 71, 10), np.arange(10.0, 180, 20)))
    sample = mmbrdf.simulate(
        ptfe,
        532,
        mmbrdf.Geometry(np.full(theta_r_deg.shape, 45.0), np.full(theta_r_deg.shape, 180.0), theta_r_deg, phi_r_deg),
    )
    _, axes = mmbrdf.plot.hemisphere(sample, 532, 45)
    shown = picture(axes[0, 0])
    assert np.isin(shown.compressed(), sample.f11).all()
    samples = len(shown)
    for index in (0, 30, 60):
        x, y = disc.direction_cosines(theta_r_deg[index], phi_r_deg[index])
        row, column = int((y + 1) / 2 * samples), int((x + 1) / 2 * samples)
        assert shown[row, column] == sample.f11[index]
    assert np.ma.getmaskarray(shown)[: samples // 3].all(), "nothing was measured below the plane of incidence"


def test_a_data_set_without_such_samples_is_refused_with_the_reason(data):
    with pytest.raises(ValueError, match="no samples at 633 nm"):
        mmbrdf.plot.hemisphere(data, 633, 30)
    with pytest.raises(ValueError, match="theta_i = 20"):
        mmbrdf.plot.residual_map(mmbrdf.material("ptfe"), data, 532, 20)


def test_the_fitted_range_is_marked_where_it_can_be_told_from_the_rim(ptfe, data):
    narrow = mmbrdf.fit(data[data.theta_r_deg < 65]).model
    _, axes = mmbrdf.plot.depolarization_map(narrow, 532, 30, samples=SAMPLES)
    radii = [patch.radius for patch in axes.patches if isinstance(patch, Circle)]
    assert min(radii) == pytest.approx(np.sin(np.radians(narrow.theta_r_max_deg)))
    _, axes = mmbrdf.plot.depolarization_map(ptfe, 532, 30, samples=SAMPLES)
    assert min(patch.radius for patch in axes.patches if isinstance(patch, Circle)) == 1


def test_plots_do_not_warn_of_the_rim(ptfe):
    with warnings.catch_warnings():
        warnings.simplefilter("error", mmbrdf.ExtrapolationWarning)
        mmbrdf.plot.hemisphere(ptfe, 532, 60, samples=SAMPLES)
        mmbrdf.plot.in_plane_curves(ptfe, 532)
        mmbrdf.plot.polar_in_plane(ptfe, 532)
        mmbrdf.plot.realizability_map(ptfe, 532, 60, samples=SAMPLES)


def test_panels_can_be_drawn_into_a_subfigure(ptfe):
    figure = Figure()
    left, right = figure.subfigures(1, 2)
    returned, axes = mmbrdf.plot.hemisphere(ptfe, 532, 0, samples=SAMPLES, figure=left, decorated=False)
    assert returned is left and len(figure.axes) == 16 and axes.shape == (4, 4)


# Residuals


def test_residuals_are_measured_minus_model(ptfe, data):
    chosen = data[np.isclose(data.theta_i_deg, 45, atol=0.01)]
    shifted = mmbrdf.Dataset(532, *chosen.geometry, chosen.mueller * 1.01)
    figure, axes = mmbrdf.plot.residual_map(ptfe, shifted, 532, 45)
    shown = np.sort(picture(axes[0, 0]).compressed())
    np.testing.assert_allclose(shown, np.sort(0.01 * chosen.f11), atol=1e-12)
    assert np.abs(picture(axes[1, 1])).max() < 1e-12
    low, high = axes[2, 3].images[0].get_clim()
    assert low == -high
    assert "sr$^{-1}$" in written(figure) and "residual" in written(figure)


# Maps


def test_the_depolarization_map_shows_the_parameter(ptfe):
    figure, axes = mmbrdf.plot.depolarization_map(ptfe, 351, 60, samples=SAMPLES)
    inside, mueller = expected_over_disc(ptfe, 351, 60)
    shown = picture(axes)
    np.testing.assert_array_equal(np.ma.getmaskarray(shown), ~inside)
    m = mueller / mueller[:, :1, :1]
    np.testing.assert_allclose(shown[inside], np.sqrt(((m**2).sum(axis=(1, 2)) - 1) / 3), rtol=1e-10)
    x, y = cell_centres()
    fitted = shown[inside][np.hypot(x, y)[inside] <= np.sin(np.radians(ptfe.theta_r_max_deg))]
    low, high = axes.images[0].get_clim()
    hundredth = np.ptp(fitted) / 10  # of a span of two digits
    assert fitted.min() - hundredth < low <= fitted.min() and fitted.max() <= high < fitted.max() + hundredth
    assert "range within the fit" in written(figure)
    assert "Bernabeu" in written(figure) and "351 nm" in written(figure)


@pytest.mark.parametrize("limit", [0, -0.1, float("nan")])
def test_limits_to_both_sides_of_zero_are_positive(ptfe, limit):
    with pytest.raises(ValueError, match="limit = .*: expected a positive number"):
        mmbrdf.plot.hemisphere(ptfe, 532, 45, limit=limit)


def test_maps_take_limits_and_axes(ptfe):
    axes = Figure().add_subplot()
    figure, returned = mmbrdf.plot.depolarization_map(
        ptfe, 532, 0, samples=SAMPLES, limits=(0, 0.2), axes=axes, colorbar=False
    )
    assert returned is axes and figure is axes.figure and figure.axes == [axes]
    assert axes.images[0].get_clim() == (0, 0.2)


def test_the_realizability_map_shows_the_margin_over_its_own_range(ptfe):
    figure, axes = mmbrdf.plot.realizability_map(ptfe, 1064, 60, samples=SAMPLES)
    inside, mueller = expected_over_disc(ptfe, 1064, 60)
    margin = mmbrdf.realizability_margin(mueller)
    np.testing.assert_array_equal(picture(axes)[inside].data, margin)
    low, high = axes.images[0].get_clim()
    assert 0 <= low <= margin.max() <= high <= 0.25 + 0.01 and high - low < 1.5 * np.ptp(margin)
    assert "eigenvalue" in written(figure)


def test_what_can_be_is_not_red_beyond_the_fit_either(ptfe):
    _, axes = mmbrdf.plot.realizability_map(ptfe, 1064, 75, samples=SAMPLES)
    (image,) = axes.images
    margin, inside = image.get_array(), expected_over_disc(ptfe, 1064, 75)[0]
    edge = np.hypot(*cell_centres()) > np.sin(np.radians(ptfe.theta_r_max_deg))
    assert margin[inside].min() >= 0 and (inside & edge).any() and margin[inside].min() == margin[inside & edge].min()
    assert image.get_clim()[0] <= margin[inside].min()


def test_the_realizability_map_is_red_where_no_scatterer_can_be():
    x, y = (axis.ravel() for axis in np.meshgrid([-0.1, 0.0, 0.1], [-0.1, 0.0, 0.1]))
    mueller = np.tile(np.diag([0.3, 0.0, 0.0, 0.0]), (9, 1, 1))
    mueller[4] = np.diag([0.3, 0.3, 0.3, -0.3])  # turns right- into left-handed light and does nothing else
    impossible = mmbrdf.Dataset(
        532, 30, 180, np.degrees(np.arcsin(np.hypot(x, y))), np.degrees(np.arctan2(y, x)), mueller
    )
    _, axes = mmbrdf.plot.realizability_map(impossible, 532, 30)
    np.testing.assert_allclose(picture(axes), [[0.25, 0.25, 0.25], [0.25, -0.5, 0.25], [0.25, 0.25, 0.25]], atol=1e-12)
    image = axes.images[0]
    assert image.cmap(image.norm(-0.5)) == to_rgba("#d62728")


# Curves


def test_in_plane_curves_are_the_polarized_brdf_with_bands():
    model = mmbrdf.material("ptfe-532")
    theta_r_deg = np.arange(-60.0, 61, 20)
    figure, axes = mmbrdf.plot.in_plane_curves(model, 532, 45, theta_r_deg=theta_r_deg, coverage=3)
    mueller = model.evaluate(532, 45, 0, np.abs(theta_r_deg), np.where(theta_r_deg < 0, 0.0, 180.0), frame="sp")
    uncertainty = mmbrdf.polarized_uncertainty(model, 532, mmbrdf.in_plane(45, theta_r_deg))
    bands = [each for each in axes.collections if isinstance(each, PolyCollection)]
    signs = {"ss": (1, 1), "sp": (1, -1), "ps": (-1, 1), "pp": (-1, -1)}  # incident, scattered
    for line, band, (name, (a, b)) in zip(axes.lines, bands, signs.items()):
        expected = (mueller[:, 0, 0] + a * mueller[:, 0, 1] + b * mueller[:, 1, 0] + a * b * mueller[:, 1, 1]) / 2
        np.testing.assert_array_equal(line.get_xdata(), theta_r_deg)
        np.testing.assert_allclose(line.get_ydata(), expected, rtol=1e-12)
        assert line.get_color() == curves.COMPONENTS[name][0]
        box = band.get_paths()[0].vertices
        for angle, value, u in zip(theta_r_deg, expected, getattr(uncertainty, name)):
            edges = box[box[:, 0] == angle, 1]
            np.testing.assert_allclose([edges.min(), edges.max()], [value - 3 * u, value + 3 * u], rtol=1e-12)
    assert len(axes.lines) == len(bands) == 4
    assert "sr$^{-1}$" in axes.get_ylabel() and "°" in axes.get_xlabel()
    assert figure.axes == [axes]


def test_of_a_scalar_brdf_in_plane_curves_are_f11_alone_with_what_was_measured():
    ptfe = mmbrdf.material("ptfe-532")
    where = mmbrdf.in_plane(45, np.arange(-60.0, 61, 5))
    f11 = ptfe.evaluate(532, *where)[:, 0, 0]
    mueller = np.full((f11.size, 4, 4), np.nan)
    mueller[:, 0, 0] = f11
    u = np.full_like(mueller, 0.001)
    data = mmbrdf.Dataset(532, *where, mueller, uncertainty=u)
    random = mmbrdf.simulate(ptfe, 532, mmbrdf.random_geometries(300, seed=1), speckle=0.01)
    scalar = random.mueller.copy()
    scalar[:, :, 1:] = scalar[:, 1:, :] = np.nan
    model = mmbrdf.fit(mmbrdf.Dataset(532, *random.geometry, scalar), orders=(4, 2)).model
    _, axes = mmbrdf.plot.in_plane_curves(model, 532, 45, data=data, theta_r_deg=[-30, 0, 30])
    curve, points = axes.lines[0], next(line for line in axes.lines if line.get_gid() == "measured-f11")
    np.testing.assert_array_equal(curve.get_ydata(), model.evaluate(532, *mmbrdf.in_plane(45, [-30, 0, 30]))[:, 0, 0])
    np.testing.assert_array_equal(points.get_ydata(), f11)
    np.testing.assert_allclose(points.get_xdata(), np.arange(-60.0, 61, 5), rtol=1e-12)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [r"$f_{\mathrm{r},11}$"]


def test_curves_are_in_the_plane_of_the_source_that_the_maps_have(anisotropic):
    plot = mmbrdf.plot
    for azimuth in ({}, {"phi_i_deg": 70.0}):
        phi_i_deg = azimuth.get("phi_i_deg", disc.SOURCE_AZIMUTH_DEG)
        theta_r_deg = np.array([-30.0, 30.0])
        where = 532, 60, phi_i_deg, 30, [phi_i_deg, phi_i_deg - 180]
        mueller = anisotropic.evaluate(*where, frame="sp")
        expected = (mueller[:, 0, 0] + mueller[:, 0, 1] + mueller[:, 1, 0] + mueller[:, 1, 1]) / 2
        _, axes = plot.in_plane_curves(anisotropic, 532, 60, theta_r_deg=theta_r_deg, **azimuth)
        np.testing.assert_allclose(axes.lines[0].get_ydata(), expected, rtol=1e-12)
        _, axes = plot.subset_study([anisotropic], anisotropic, 532, 60, theta_r_deg=theta_r_deg, **azimuth)
        np.testing.assert_allclose(axes.lines[4].get_ydata(), expected, rtol=1e-12)
        _, axes = plot.polar_in_plane(anisotropic, 532, 60, **azimuth)
        np.testing.assert_allclose(axes.lines[0].get_ydata()[[60, 120]], mueller[:, 0, 0], rtol=1e-12)
    other = anisotropic.evaluate(532, 60, 0, 30, 0)[0, 0]
    assert abs(other / mueller[0, 0, 0] - 1) > 0.05, "the sample looks different from there"


def test_curves_are_scaled_to_the_fitted_angles_and_grey_beyond():
    model = mmbrdf.material("ptfe-1064")
    _, axes = mmbrdf.plot.in_plane_curves(model, 1064, 75)
    low, high = axes.get_ylim()
    fitted = np.abs(axes.lines[0].get_xdata()) <= model.theta_r_max_deg
    values = np.array([line.get_ydata() for line in axes.lines])
    inside = values[:, fitted]
    assert low < inside.min() and inside.max() < high < inside.max() + np.ptp(inside)
    assert values.min() < low or values.max() > high, "at 75 degrees the fit runs away beyond what was fitted"
    edges = sorted(x for patch in axes.patches for x in np.unique(patch.get_xy()[:, 0]))
    np.testing.assert_allclose(edges, [-90, -model.theta_r_max_deg, model.theta_r_max_deg, 90])


def test_colours_of_components_are_those_of_the_paper():
    colours = [to_rgba(colour)[:3] for colour in (stroke.color for stroke in curves.COMPONENTS.values())]
    assert colours[0] == (0, 0, 0)
    assert [int(np.argmax(colour)) for colour in colours[1:]] == [0, 1, 2]  # red, green, blue


def test_without_a_covariance_there_are_no_bands(data, tmp_path):
    path = tmp_path / "model.csv"
    mmbrdf.fit(data, basis="germer2017").model.save(path)
    published = mmbrdf.load_model(path)
    assert not published.has_covariance
    _, axes = mmbrdf.plot.in_plane_curves(published, 532)
    assert not axes.collections and len(axes.lines) == 4


def test_a_subset_study_draws_parts_thin_and_the_reference_thick(ptfe):
    part = mmbrdf.material("ptfe-532")
    _, axes = mmbrdf.plot.subset_study([part, part], ptfe, 532, 45)
    widths = [line.get_linewidth() for line in axes.lines]
    assert len(widths) == 12 and min(widths[:4]) > 2 * max(widths[4:])
    angles = axes.lines[0].get_xdata()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mmbrdf.ExtrapolationWarning)
        for line, value in zip(axes.lines[4:8], mmbrdf.polarized_curve(part, 532, mmbrdf.in_plane(45, angles))):
            np.testing.assert_array_equal(line.get_ydata(), value)


def test_the_polar_plot_has_forward_scattering_on_the_right_and_the_normal_up(ptfe):
    figure, axes = mmbrdf.plot.polar_in_plane(ptfe, [351, 1064], 45)
    first, second, lambertian = axes.lines
    angles = np.degrees(first.get_xdata())
    forward = angles == 60
    assert first.get_ydata()[forward] == pytest.approx(evaluated(ptfe, 351, 45, 0, 60, 180)[0, 0], rel=1e-12)
    assert second.get_ydata()[forward] == pytest.approx(evaluated(ptfe, 1064, 45, 0, 60, 180)[0, 0], rel=1e-12)
    np.testing.assert_allclose(lambertian.get_ydata(), 1 / np.pi)
    figure.canvas.draw()
    place = axes.transData.transform
    centre, right, up = place((0, 0)), place((np.radians(60), 0.3)), place((0, 0.3))
    assert right[0] > centre[0] and abs(up[0] - centre[0]) < 1e-6 and up[1] > centre[1]
    assert "sr$^{-1}$" in written(figure)


# Coefficients


@pytest.mark.parametrize("power", [0, 1])
def test_the_spectrum_shows_every_coefficient_of_a_power_with_its_uncertainty(ptfe, power):
    data = mmbrdf.simulate(ptfe, [351, 532], mmbrdf.random_geometries(200, seed=1), speckle=0.006, seed=1)
    ptfe = mmbrdf.fit(data, uncertainty="noise").model
    figure, axes = mmbrdf.plot.coefficient_spectrum(ptfe, power=power, coverage=2)
    shown = np.concatenate(
        [np.asarray(each.get_offsets()) for each in axes.collections if isinstance(each, PathCollection)]
    )
    shown = shown[np.argsort(shown[:, 0])]
    values = np.concatenate([np.atleast_2d(block.coefficients)[power] for block in ptfe.blocks])
    np.testing.assert_array_equal(shown[:, 1], np.abs(values))
    tops = np.concatenate(
        [[path.vertices[:, 1].max() for path in container.lines[2][0].get_paths()] for container in axes.containers]
    )
    modes = [len(block.modes) for block in ptfe.blocks]
    u = np.concatenate(
        [np.sqrt(np.diag(block.covariance))[power * n : (power + 1) * n] for block, n in zip(ptfe.blocks, modes)]
    )
    np.testing.assert_allclose(tops, np.abs(values) + 2 * u, rtol=1e-12)
    assert axes.get_yscale() == "log" and "sr$^{-1}$" in axes.get_xlabel()
    assert ("µm$^{-1}$" in axes.get_xlabel()) == (power == 1)
    assert "22\n23\n32\n33" in written(figure)


def test_a_power_that_the_model_lacks_is_refused(ptfe):
    with pytest.raises(ValueError, match="power = 2"):
        mmbrdf.plot.coefficient_spectrum(ptfe, power=2)


# Without a display


def test_plots_need_no_display_and_no_pyplot(tmp_path):
    program = (
        "import sys, mmbrdf, mmbrdf.plot\n"
        "figure, _ = mmbrdf.plot.hemisphere(mmbrdf.material('ptfe'), 532, 60, samples=11)\n"
        "figure.savefig(sys.argv[1])\n"
        "assert 'matplotlib.pyplot' not in sys.modules\n"
    )
    path = tmp_path / "picture.png"
    subprocess.run([sys.executable, "-c", program, str(path)], check=True)
    assert path.read_bytes().startswith(b"\x89PNG")
