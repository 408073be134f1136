# SPDX-License-Identifier: BSD-3-Clause
"""Maps of any number, measured points, reflectances, parts of uncertainties, calibrations: what the pictures hold."""

import json
import warnings
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

import mmbrdf
import mmbrdf.plot
from mmbrdf.plot import colours, disc
from pictures import SAMPLES, rendered, written

plot = mmbrdf.plot


def quietly(function, *arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mmbrdf.ExtrapolationWarning)
        return function(*arguments, **options)


def directions_of(image):
    """Polar angle and azimuth of the cells within the disc, and where these are."""
    rows, columns = image.shape
    x, y = np.meshgrid(-1 + (np.arange(columns) + 0.5) * 2 / columns, -1 + (np.arange(rows) + 0.5) * 2 / rows)
    inside = np.hypot(x, y) < 1
    return np.degrees(np.arcsin(np.hypot(x, y)[inside])), np.degrees(np.arctan2(y[inside], x[inside])), inside


def shown(axes):
    (image,) = axes.images
    return image.get_array()


@pytest.fixture(scope="module")
def noisy(samples):
    """The same samples with the uncertainties of their noise."""
    u = np.full(samples.mueller.shape, 0.01)
    u[:, 0, 0] = 0.01 * samples.f11
    return mmbrdf.Dataset(532, *samples.geometry, samples.mueller, uncertainty=u)


@pytest.fixture(scope="module")
def fitted(noisy):
    return mmbrdf.fit(noisy).model


# Maps


@pytest.mark.parametrize("name", ["11", "34", "reflectance_factor", "f_sp", "depolarization_ratio", "purity"])
def test_a_map_shows_a_number_by_its_name(ptfe, name):
    _, axes = plot.map(ptfe, name, 532, 60, samples=SAMPLES)
    theta_r, phi_r, inside = directions_of(shown(axes))
    table = name not in ("11", "34", "reflectance_factor")
    mueller = quietly(ptfe.evaluate, 532, 60, 180, theta_r, phi_r, frame="sp" if table else "xy")
    expected = {
        "11": mueller[:, 0, 0],
        "34": mueller[:, 2, 3] / mueller[:, 0, 0],
        "reflectance_factor": np.pi * mueller[:, 0, 0],
    }.get(name)
    expected = getattr(mmbrdf, name)(mueller) if expected is None else expected
    np.testing.assert_allclose(shown(axes)[inside].data, expected, rtol=1e-12, atol=1e-15)
    assert f"frame {'sp' if table else 'xy'}" in axes.get_title()


def test_a_map_shows_any_function_of_matrices_in_the_frame_it_asks_for(ptfe):
    def trace(mueller):
        return np.trace(mueller, axis1=-2, axis2=-1)

    _, axes = plot.map(ptfe, trace, 532, 60, samples=SAMPLES, frame="scattering_plane")
    theta_r, phi_r, inside = directions_of(shown(axes))
    mueller = quietly(ptfe.evaluate, 532, 60, 180, theta_r, phi_r, frame="scattering_plane")
    np.testing.assert_allclose(shown(axes)[inside].data, trace(mueller), rtol=1e-12)
    assert "trace" in written(axes.figure) and "frame scattering plane" in axes.get_title()
    with pytest.raises(ValueError, match="gives an array of the shape"):
        plot.map(ptfe, lambda mueller: 1.0, 532, 60, samples=SAMPLES)


def test_a_map_of_scattered_light_needs_the_incident_light(ptfe):
    with pytest.raises(ValueError, match="'scattered_S4' needs stokes"):
        plot.map(ptfe, "scattered_S4", 532, 60)
    _, axes = plot.map(ptfe, "scattered_S1", 532, 60, stokes=[1, 1, 0, 0], samples=SAMPLES)
    theta_r, phi_r, inside = directions_of(shown(axes))
    mueller = quietly(ptfe.evaluate, 532, 60, 180, theta_r, phi_r, frame="sp")
    np.testing.assert_allclose(shown(axes)[inside].data, mueller[:, 0, 0] + mueller[:, 0, 1], rtol=1e-12)


def test_unknown_names_frames_and_kinds_are_refused_with_those_there_are(ptfe, noisy):
    with pytest.raises(ValueError, match="quantity = 'depolarisation': expected one of 11, 12, .*depolarization"):
        plot.map(ptfe, "depolarisation", 532, 60)
    with pytest.raises(ValueError, match="'f_sp' is of the frame sp, not of xy"):
        plot.map(ptfe, "f_sp", 532, 60, frame="xy")
    with pytest.raises(ValueError, match="show = 'uncertainty', expected one of value, u, value / u"):
        plot.map(ptfe, "11", 532, 60, show="uncertainty")
    with pytest.raises(ValueError, match="scale = 'paper2'"):
        plot.hemisphere(ptfe, 532, 60, scale="paper2")
    with pytest.raises(ValueError, match="width_cm = 0"):
        plot.hemisphere(ptfe, 532, 60, width_cm=0)


@pytest.mark.parametrize("name", ["11", "22", "f_sp", "depolarization"])
def test_a_map_of_u_has_the_standard_uncertainty_of_the_library(ptfe, name):
    _, axes = plot.map(ptfe, name, 532, 45, show="u", samples=9, terms={"calibration": 0.01})
    theta_r, phi_r, inside = directions_of(shown(axes))
    where = 532, 45, 180, theta_r, phi_r
    if name in ("11", "22"):
        mueller = quietly(ptfe.evaluate, *where)
        covariance = quietly(ptfe.covariance, *where, terms={"calibration": 0.01})
        gradient = np.zeros_like(mueller)
        gradient[:, 0, 0] = 1 if name == "11" else -mueller[:, 1, 1] / mueller[:, 0, 0] ** 2
        if name == "22":
            gradient[:, 1, 1] = 1 / mueller[:, 0, 0]
        expected = mmbrdf.standard_uncertainty(gradient, covariance)
    else:
        expected = quietly(ptfe.analyze, *where, terms={"calibration": 0.01})[name].u
    # Derivatives are numerical, to 1e-10 for smooth numbers; the last is one where light is polarized little.
    np.testing.assert_allclose(shown(axes)[inside].data, expected, rtol=1e-6)


def test_what_a_fit_leaves_over_u_is_of_the_size_of_one(fitted, noisy):
    _, axes = plot.map(noisy, "22", 532, 60, minus=fitted, show="value / u")
    values = shown(axes).compressed()
    assert 0.8 < np.sqrt((values**2).mean()) < 1.2  # 304 samples: within 0.04 of one, but for what the fit has taken
    assert axes.images[0].get_clim() == (-3, 3)
    _, panels = plot.residual_map(fitted, noisy, 532, 60, over_u=True)
    np.testing.assert_allclose(shown(panels[1, 1]).compressed(), values, rtol=1e-5)


def test_a_residual_over_u_needs_the_noise_of_the_samples_and_a_covariance(ptfe, fitted, samples, tmp_path):
    for draw in (
        lambda: plot.residual_map(fitted, samples, 532, 60, over_u=True),
        lambda: plot.map(samples, "11", 532, 60, minus=fitted, show="value / u"),
    ):
        with pytest.raises(ValueError, match="the samples have no uncertainties"):
            draw()
    mmbrdf.in_published_form(mmbrdf.material("ptfe-532")).save(tmp_path / "model.csv")
    with pytest.raises(ValueError, match="the model has no covariance"):
        plot.map(mmbrdf.load(tmp_path / "model.csv"), "11", 532, 60, show="u")


def test_models_without_a_name_are_told_apart_in_a_title(ptfe):
    nameless = ptfe.renamed("")
    for source, minus, title in (
        (nameless, ptfe, "model $-$ ptfe"),
        (ptfe, nameless, "ptfe $-$ model"),
        (nameless, nameless, "model $-$ another"),
    ):
        _, axes = plot.map(source, "11", 532, 45, minus=minus, samples=21)
        assert axes.get_title().startswith(title)


def test_the_difference_of_two_models_is_a_map(ptfe):
    other = mmbrdf.material("ptfe-532")
    _, axes = plot.map(ptfe, "11", 532, 45, minus=other, samples=SAMPLES)
    theta_r, phi_r, inside = directions_of(shown(axes))
    where = 532, 45, 180, theta_r, phi_r
    expected = quietly(ptfe.evaluate, *where)[:, 0, 0] - quietly(other.evaluate, *where)[:, 0, 0]
    np.testing.assert_allclose(shown(axes)[inside].data, expected, atol=1e-14)
    low, high = axes.images[0].get_clim()
    assert low == -high and "ptfe-532" in axes.get_title()


def test_limits_hold_what_was_fitted_and_are_said(ptfe, data):
    figure, axes = plot.hemisphere(ptfe, 532, 60, samples=SAMPLES)
    for places in ([(0, 0)], [(1, 1), (1, 2), (2, 1), (2, 2), (3, 3)], [(0, 1), (3, 2), (1, 3)]):
        for place in places:
            image = axes[place].images[0]
            low, high = image.get_clim()
            theta_r, _, inside = directions_of(image.get_array())
            values = image.get_array()[inside].data[theta_r <= ptfe.theta_r_max_deg]
            assert low <= values.min() and values.max() <= high
            assert place == (0, 0) or low == -high
    assert axes[1, 1].images[0].get_clim() == axes[3, 3].images[0].get_clim() != axes[0, 1].images[0].get_clim()
    assert "range within the fit" in written(figure)
    ends = {text.get_text() for bar in figure.axes[16:] for text in bar.get_yticklabels()}
    high = axes[1, 1].images[0].get_clim()[1]
    assert {f"{high:g}", f"\N{MINUS SIGN}{high:g}"} <= ends, "a reader finds the limits at the ends of the scale"
    assert "1 to 99 % of the samples" in written(plot.hemisphere(data, 532, 60)[0])
    assert "3 rms" in written(plot.residual_map(ptfe, data, 532, 60)[0])


def test_two_in_a_hundred_samples_are_beyond_the_limits_of_their_scale(noisy):
    _, axes = plot.hemisphere(noisy, 532, 60)
    large = [(1, 1), (1, 2), (2, 1), (2, 2), (3, 3)]
    small = [place for place in np.ndindex(4, 4) if place not in large and place != (0, 0)]
    for places in ([(0, 0)], large, small):
        low, high = axes[places[0]].images[0].get_clim()
        values = np.concatenate([shown(axes[place]).compressed() for place in places])
        assert ((values < low) | (values > high)).mean() <= 0.02


# Marks


def marks(axes):
    return {line.get_gid(): (line.get_xdata()[0], line.get_ydata()[0]) for line in axes.lines if line.get_gid()}


def test_source_and_specular_direction_are_marked_in_every_disc(ptfe, data):
    expected = {"source": (-np.sin(np.radians(60)), 0), "specular": (np.sin(np.radians(60)), 0)}
    for figure, axes in (
        plot.hemisphere(ptfe, 532, 60, samples=SAMPLES),
        plot.residual_map(ptfe, data, 532, 60),
        plot.map(ptfe, "11", 532, 60, samples=SAMPLES),
        plot.depolarization_map(ptfe, 532, 60, samples=SAMPLES),
        plot.realizability_map(ptfe, 532, 60, samples=SAMPLES),
    ):
        for each in np.ravel(axes):
            found = marks(each)
            assert found.keys() == expected.keys()
            for name, place in expected.items():
                np.testing.assert_allclose(found[name], place, atol=1e-12)
        assert "source and retro" in written(figure) and "specular" in written(figure)
    _, axes = plot.map(ptfe, "11", 532, 30, phi_i_deg=90, samples=SAMPLES)
    np.testing.assert_allclose(marks(axes)["source"], (0, 0.5), atol=1e-12)


def test_the_frame_is_said(ptfe, data):
    for frame, words in (("xy", "frame xy"), ("sp", "frame sp"), ("scattering_plane", "frame scattering plane")):
        assert words in written(plot.hemisphere(ptfe, 532, 60, samples=5, frame=frame)[0])
        assert words in written(plot.residual_map(ptfe, data, 532, 60, frame=frame)[0])


def test_residuals_in_another_frame_are_differences_of_matrices_there(ptfe, data):
    chosen = data[np.isclose(data.theta_i_deg, 45, atol=0.01)]
    moved = mmbrdf.Dataset(532, *chosen.geometry, chosen.mueller + 0.01 * np.eye(4))
    _, axes = plot.residual_map(ptfe, moved, 532, 45, frame="sp")
    mueller = mmbrdf.change_frame(moved.mueller, *chosen.geometry, "xy", "sp")
    model = ptfe.evaluate(532, *chosen.geometry, frame="sp")
    expected = mueller[:, 1, 2] / mueller[:, 0, 0] - model[:, 1, 2] / model[:, 0, 0]
    np.testing.assert_allclose(np.sort(shown(axes[1, 2]).compressed()), np.sort(expected), atol=1e-12)


def grounds(axes):
    """Hatch of what is behind the cells."""
    return [patch.get_hatch() for patch in axes.patches if patch.get_zorder() == 0]


def test_what_has_no_value_is_hatched_and_named_and_models_have_none(ptfe, data):
    figure, axes = plot.hemisphere(data, 532, 30)
    assert all(hatch for each in axes.flat for hatch in grounds(each)) and "no value" in written(figure)
    figure, axes = plot.hemisphere(ptfe, 532, 30, samples=SAMPLES)
    assert not any(hatch for each in axes.flat for hatch in grounds(each)) and "no value" not in written(figure)


def test_a_cell_without_a_value_has_the_lines_of_the_hatch(data):
    axes = Figure(figsize=(4, 4), dpi=100).add_axes((0, 0, 1, 1))
    plot.map(data, "11", 532, 30, axes=axes, colorbar=False)
    pixels = rendered(axes.figure)[::-1, :, :3]

    def shades(x, y):
        """How many there are in the middle of the cell at these direction cosines."""
        column, row = axes.transData.transform((x, y)).astype(int)
        return len(np.unique(pixels[row - 7 : row + 8, column - 7 : column + 8].reshape(-1, 3), axis=0))

    assert shades(0.3, 0.3) == 1 and shades(0.0, -0.93) > 3, "below the lowest row of cells nothing was measured"


# Curves


def test_measured_points_lie_over_the_curves(noisy, fitted):
    figure, axes = plot.in_plane_curves(fitted, 532, 60, data=noisy, coverage=2)
    points = {line.get_gid(): line for line in axes.lines if str(line.get_gid()).startswith("measured")}
    assert set(points) == {f"measured-{name}" for name in ("ss", "sp", "ps", "pp")}
    plane = np.isclose(noisy.theta_i_deg, 60, atol=0.01) & (np.abs(np.sin(np.radians(noisy.phi_r_deg))) < 1e-6)
    chosen = noisy[plane]
    mueller = mmbrdf.change_frame(chosen.mueller, *chosen.geometry, "xy", "sp")
    forward = np.where(np.cos(np.radians(chosen.phi_r_deg)) > 0, 1, -1)
    for name, line in points.items():
        np.testing.assert_allclose(line.get_ydata(), getattr(mmbrdf, f"f_{name[-2:]}")(mueller), rtol=1e-12)
        np.testing.assert_allclose(line.get_xdata(), forward * chosen.theta_r_deg, atol=1e-9)
        assert to_rgba(line.get_color()) == to_rgba(colours.COMPONENTS[name[-2:]].color)
    assert "points: measured" in written(figure) and "bars" in written(figure)
    assert [len(line.get_xdata()) for line in axes.lines[:4]] == [181] * 4, "the curves come first"


def test_bars_of_points_are_those_of_the_samples_noise(ptfe):
    angle = np.array([-40.0, 20.0])
    where = mmbrdf.in_plane(45, angle)
    mueller = ptfe.evaluate(532, *where)
    u = np.zeros((2, 4, 4))
    u[:, 0, 0], u[:, 1, 1] = 0.02, 0.05  # of f11 in sr^-1, of f22 / f11
    data = mmbrdf.Dataset(532, *where, mueller, uncertainty=u)
    _, axes = plot.in_plane_curves(ptfe, 532, 45, data=data, coverage=3, bands=False)
    m = mueller / mueller[:, :1, :1]
    # f_ss = f11 (1 + m12 + m21 + m22) / 2, in the plane of incidence the same in xy and sp.
    slope = (1 + m[:, 0, 1] + m[:, 1, 0] + m[:, 1, 1]) / 2
    expected = 3 * np.hypot(slope * 0.02, mueller[:, 0, 0] / 2 * 0.05)
    bars = axes.collections[0].get_paths()
    half = [np.ptp(bar.vertices[:, 1]) / 2 for bar in bars]
    np.testing.assert_allclose(half, expected, rtol=1e-6)


def test_samples_at_another_azimuth_count_for_isotropic_models_only(ptfe, anisotropic):
    where = mmbrdf.in_plane(45, np.array([-40.0, 20.0]))
    turned = mmbrdf.Geometry(where.theta_i_deg, where.phi_i_deg + 70, where.theta_r_deg, where.phi_r_deg + 70)
    data = mmbrdf.simulate(ptfe, 532, turned)
    assert len(plot.in_plane_curves(ptfe, 532, 45, data=data)[1].lines) == 8
    with pytest.raises(ValueError, match="no samples at 532 nm with theta_i = 45 degrees in the plane"):
        plot.in_plane_curves(anisotropic, 532, 45, data=data)
    with pytest.raises(ValueError, match="theta_i = 30 degrees in the plane of incidence, to 0.5 degrees"):
        plot.in_plane_curves(ptfe, 532, 30, data=data)


def test_the_axis_says_which_side_is_forward(ptfe):
    _, axes = plot.in_plane_curves(ptfe, 532)
    assert axes.get_xlabel().index("source side") < axes.get_xlabel().index("forward")
    top = axes.child_axes[0]
    named = dict(zip([text.get_text() for text in top.get_xticklabels()], top.get_xticks()))
    assert named == {"specular": 45, "retro": -45}


def test_several_wavelengths_in_polar_coordinates_are_told_apart_in_a_panel_below(ptfe):
    figure, axes = plot.polar_in_plane(ptfe, [351, 532, 1064], 45)
    polar, below = figure.axes
    assert polar is axes and "%" in below.get_ylabel()
    first, second = axes.lines[0].get_ydata(), axes.lines[2].get_ydata()
    np.testing.assert_allclose(below.lines[3].get_ydata(), 100 * (second / first - 1), rtol=1e-12)
    assert len(plot.polar_in_plane(ptfe, 532)[0].axes) == 1


# Reflectances


def test_reflectance_factors_are_pi_f11_with_bands(ptfe):
    theta_i = np.arange(0.0, 71, 10)
    views = [(0, 0), (30, 180)]
    options = dict(views=views, theta_i_deg=theta_i, coverage=3, terms={"scale": 0.01})
    figure, axes = plot.reflectance_factor(ptfe, [351, 532], **options)
    bands = [each for each in axes.collections if isinstance(each, PolyCollection)]
    asked = [(nm, view) for nm in (351, 532) for view in views]
    assert len(axes.lines) == len(bands) == 4
    for (nm, (theta_r, azimuth)), line, band in zip(asked, axes.lines, bands):
        where = nm, theta_i, 0, theta_r, azimuth
        value = np.pi * ptfe.evaluate(*where)[:, 0, 0]
        u = np.pi * ptfe.evaluate_uncertainty(*where, terms={"scale": 0.01})[:, 0, 0]
        np.testing.assert_allclose(line.get_ydata(), value, rtol=1e-12)
        edges = band.get_paths()[0].vertices
        for angle, middle, half in zip(theta_i[1:-1], value[1:-1], 3 * u[1:-1]):
            ends = edges[edges[:, 0] == angle, 1]
            np.testing.assert_allclose([ends.min(), ends.max()], [middle - half, middle + half], rtol=1e-9)
    text = written(figure)
    for words in ("351 nm", "532 nm", "forward", "zenith", "reflectance factor", "$k$ = 3", "scale"):
        assert words in text


def test_wavelengths_that_were_not_fitted_are_said_to_be_so(ptfe):
    text = written(plot.reflectance_factor(ptfe, [443, 532, 1200], bands=False)[0])
    assert "443 nm, interpolated" in text and "1200 nm, beyond the fit" in text and "532 nm," not in text


def test_the_dhr_is_that_of_the_library_against_angle_and_wavelength(ptfe):
    angles = np.array([0.0, 30, 60])
    _, axes = plot.reflectance_against_angle(ptfe, [351, 532], theta_i_deg=angles, bands=False)
    for line, nm in zip(axes.lines, (351, 532)):
        np.testing.assert_array_equal(
            line.get_ydata(), mmbrdf.directional_hemispherical_reflectance(ptfe, nm, angles, 180)
        )
    figure, axes = plot.reflectance_against_wavelength(ptfe, [300, 400, 700], theta_i_deg=[8, 45], bands=False)
    for line, angle in zip(axes.lines, (8, 45)):
        nm = line.get_xdata()
        assert nm.tolist() == [300, 351, 400, 532, 633, 700], "where it was fitted is among them"
        expected = quietly(mmbrdf.directional_hemispherical_reflectance, ptfe, nm, angle, 180)
        np.testing.assert_allclose(line.get_ydata(), expected, rtol=1e-12)
        assert nm[line.get_markevery()].tolist() == [351, 532, 633]
    grey = [np.unique(patch.get_xy()[:, 0]).tolist() for patch in axes.patches]
    assert grey == [[300, 351]], "beyond the fitted wavelengths"
    with pytest.raises(ValueError, match="give those to draw"):
        plot.reflectance_against_wavelength(mmbrdf.material("ptfe-532"))


def test_bands_of_a_dhr_are_its_uncertainty(ptfe):
    angles = np.array([10.0, 30, 50])
    _, axes = plot.reflectance_against_angle(ptfe, 532, theta_i_deg=angles, coverage=2, terms={"scale": 0.01})
    u = mmbrdf.directional_hemispherical_uncertainty(ptfe, 532, 30, 180, terms={"scale": 0.01})
    edges = axes.collections[0].get_paths()[0].vertices
    assert np.ptp(edges[edges[:, 0] == 30, 1]) == pytest.approx(4 * u, rel=1e-9)


# Parts


def heights(axes):
    """Of the bodies of a stack, at each abscissa."""
    bodies = [each for each in axes.collections if isinstance(each, PolyCollection)]
    for body in bodies:
        edges = body.get_paths()[0].vertices
        yield {x: np.ptp(edges[edges[:, 0] == x, 1]) for x in np.unique(edges[:, 0])}


def test_parts_of_an_uncertainty_are_stacked_by_their_share_of_its_square(ptfe):
    angles = np.array([-60.0, -20.0, 30.0, 60.0])
    options = dict(theta_r_deg=angles, terms={"calibration": 0.01})
    _, axes = plot.uncertainty_parts(ptfe, 532, 45, quantity="f_sp", **options)
    found = ptfe.analyze(532, *mmbrdf.in_plane(45, angles), terms={"calibration": 0.01})["f_sp"]
    np.testing.assert_allclose(axes.lines[0].get_ydata(), found.u, rtol=1e-6)
    for body, part in zip(heights(axes), found.parts.values()):
        for x, square, u in list(zip(angles, part**2, found.u))[1:-1]:
            assert body[x] == pytest.approx(square / u, rel=1e-6, abs=1e-12)


def test_the_upper_edge_of_the_parts_of_f11_and_dhr_is_u(ptfe):
    angles = np.array([-40.0, 20.0, 50.0])
    figure, axes = plot.uncertainty_parts(ptfe, 532, 45, theta_r_deg=angles)
    u = ptfe.evaluate_uncertainty(532, *mmbrdf.in_plane(45, angles))[:, 0, 0]
    np.testing.assert_allclose(axes.lines[0].get_ydata(), u, rtol=1e-6)
    assert "sr$^{-1}$" in axes.get_ylabel() and "sample and noise" in written(figure)
    _, axes = plot.uncertainty_parts(ptfe, 532, [8, 45], quantity="dhr", relative=True)
    where = ptfe, 532, [8, 45], 180
    expected = mmbrdf.directional_hemispherical_uncertainty(*where) / mmbrdf.directional_hemispherical_reflectance(
        *where
    )
    np.testing.assert_allclose(axes.lines[0].get_ydata(), 100 * expected, rtol=1e-6)
    with pytest.raises(ValueError, match="quantity = 'f12': expected one of dhr, f11, depolarization"):
        plot.uncertainty_parts(ptfe, 532, 45, quantity="f12")


def test_the_anisotropy_is_that_of_the_report(ptfe, data):
    rows = [row for row in json.loads(mmbrdf.report_json(ptfe, "", [351]))["sample"] if row["wavelength_nm"] == 532]
    figure, axes = plot.anisotropy(ptfe, 532)
    by_label = {line.get_label(): line.get_ydata() for line in axes.lines}
    expected = [row["once_per_turn"] or np.nan for row in rows]
    np.testing.assert_array_equal(by_label["once per turn"], expected)
    assert [text.get_text() for text in axes.get_xticklabels()] == [row["block"].replace(",", "\n") for row in rows]
    assert "532 nm" in written(figure) and axes.get_yscale() == "log"
    with pytest.raises(ValueError, match="the fit was at 351, 532, 633, 1064 nm"):
        plot.anisotropy(ptfe, 600)
    with pytest.raises(ValueError, match="says nothing of its sample"):
        plot.anisotropy(mmbrdf.fit(data, uncertainty="noise"))


# Instruments


def test_a_calibration_shows_what_its_figure_of_merit_sums_up(tmp_path):
    path = tmp_path / "references.csv"
    goniometer = mmbrdf.Goniometer(seed=1)
    goniometer.write_references(path, 532)
    instrument = mmbrdf.calibrate(path, film=goniometer.film)
    figure, (above, below) = plot.calibration(instrument, path, film=goniometer.film)
    off = np.concatenate([line.get_ydata() for line in above.lines if len(line.get_ydata()) > 2])
    assert off.size == 54 * 15
    # A wafer is fitted by itself there, and by the film here: within a twentieth.
    assert np.sqrt((off**2).mean()) == pytest.approx(instrument.figure_of_merit, rel=0.05)
    by_reference = np.concatenate([line.get_ydata() for line in below.lines])
    assert np.sqrt((by_reference**2).mean()) == pytest.approx(np.sqrt((off**2).mean()), rel=1e-12)
    assert {"empty", "polarizer", "wafer"} == {line.get_label() for line in below.lines}
    _, (_, below) = plot.calibration(instrument, path)
    assert {line.get_label() for line in below.lines} == {"empty", "polarizer"}, "without a film, no wafers"
    (tmp_path / "other.csv").write_text("a,b\n1,2\n")
    with pytest.raises(ValueError, match="other.csv: not readings of references"):
        plot.calibration(instrument, tmp_path / "other.csv")


# Columns


@pytest.fixture(scope="module", params=[8, 17, None])
def drawn(request, ptfe, fitted, noisy):
    """A width in cm, and a picture of each kind that has it, drawn once for all that is asked of it."""
    size = dict(width_cm=request.param)
    figures = [
        figure
        for figure, _ in (
            plot.hemisphere(noisy, 532, 60, **size),
            plot.residual_map(fitted, noisy, 532, 60, **size),
            plot.map(noisy, "depolarization", 532, 60, **size),
            plot.realizability_map(ptfe, 532, 60, samples=SAMPLES, **size),
            plot.in_plane_curves(fitted, 532, 60, data=noisy, **size),
            plot.polar_in_plane(ptfe, [351, 532, 633, 1064], **size),
            plot.reflectance_factor(ptfe, [351, 532], views=[(0, 0), (30, 180)], **size),
            plot.reflectance_against_angle(ptfe, [351, 532], bands=False, **size),
            plot.reflectance_against_wavelength(ptfe, bands=False, **size),
            plot.uncertainty_parts(ptfe, 532, terms={"calibration": 0.002}, **size),
            plot.anisotropy(ptfe, **size),
            plot.coefficient_spectrum(ptfe, power=1, **size),
            plot.directions(noisy, 532, **size),
        )
    ]
    for figure in figures:
        rendered(figure)
    return request.param, figures


def test_a_column_has_its_width_and_its_fonts(drawn):
    width_cm, figures = drawn
    if width_cm is None:
        pytest.skip("no column")
    points = {8: 7, 17: 8}[width_cm]
    for figure in figures:
        assert figure.get_figwidth() * 2.54 == pytest.approx(width_cm)
        texts = [text for text in figure.findobj(Text) if text.get_text().strip()]
        assert all(5.8 <= text.get_fontsize() <= points + 0.5 for text in texts if text.get_visible())


def overhangs(figure):
    """By how many inches what is drawn is cut by the edges of the figure."""
    renderer = figure.canvas.get_renderer()
    if any(axes.name == "polar" for axes in figure.axes):
        # The square of the whole disc, of which half is drawn, may go beyond the figure: its words may not.
        words = [each.get_window_extent(renderer) for axes in figure.axes for each in _words(axes)]
        box = Bbox.union(words).transformed(figure.dpi_scale_trans.inverted())
    else:
        box = figure.get_tightbbox(renderer)
    return max(-box.x0, -box.y0, box.x1 - figure.get_figwidth(), box.y1 - figure.get_figheight())


def _words(axes):
    texts = [axes.title, axes.xaxis.label, axes.yaxis.label, *axes.texts, *axes.get_xticklabels()]
    legend = [] if axes.get_legend() is None else axes.get_legend().get_texts()
    return [text for text in texts + legend if text.get_text().strip()]


def test_no_text_is_cut_by_the_edge_of_a_figure(drawn):
    for figure in drawn[1]:
        assert overhangs(figure) < 0.015  # a pixel of the screen


def test_a_picture_leaves_the_settings_of_matplotlib_as_they_were(ptfe):
    from matplotlib import rcParams

    before = dict(rcParams)
    plot.hemisphere(ptfe, 532, 60, samples=5, width_cm=8)
    with pytest.raises(ValueError):
        plot.map(ptfe, "nothing", 532, 60, width_cm=8)
    assert dict(rcParams) == before


def test_the_calls_of_the_documentation_run_as_they_stand(fitted, noisy, tmp_path, monkeypatch):
    page = (Path(__file__).parents[2] / "docs/python.md").read_text(encoding="utf-8")
    gallery = page[page.index("## Pictures") :].split("```")[1].removeprefix("python\n")
    monkeypatch.chdir(tmp_path)
    goniometer = mmbrdf.Goniometer(seed=1)
    goniometer.write_references("references.csv", 532)
    instrument = mmbrdf.calibrate("references.csv", film=goniometer.film)
    several = mmbrdf.simulate(
        mmbrdf.material("ptfe"), [443, 532, 670], mmbrdf.random_geometries(150, seed=1), speckle=0.01
    )
    model = mmbrdf.fit(several).model
    names = {"data": noisy, "model": model, "instrument": instrument}
    for line in gallery.splitlines():
        if "data=data" in line or "minus=model" in line or "(model, data" in line:
            exec(line, names | {"model": fitted})  # the samples are of one wavelength
        elif line:
            exec(line, names)
    assert (tmp_path / "directions.pdf").read_bytes().startswith(b"%PDF")
    drawn = {name for name in plot.__all__ if f"plot.{name}(" in gallery}
    assert set(plot.__all__) - drawn == {
        "depolarization_map",
        "realizability_map",
        "low_order_residuals",
        "suspicious",
        "plan",
        "subset_study",
    }


def test_titles_say_where_a_model_was_not_fitted(ptfe):
    plot = mmbrdf.plot
    assert "beyond the fit" in plot.map(ptfe, "11", 2500, 45, samples=SAMPLES)[1].get_title()
    assert "85°, beyond the fit" in plot.map(ptfe, "11", 532, 85, samples=SAMPLES)[1].get_title()
    assert "450 nm, interpolated" in plot.map(ptfe, "11", 450, 45, samples=SAMPLES)[1].get_title()
    assert "fit" not in plot.map(ptfe, "11", 532, 45, samples=SAMPLES)[1].get_title()
    assert "85°, beyond the fit" in plot.in_plane_curves(ptfe, 532, 85)[1].get_title()
    assert "2500 nm, beyond the fit" in plot.reflectance_factor(ptfe, 2500, bands=False)[1].get_title()


def test_a_view_at_a_negative_angle_is_that_on_the_other_side(ptfe):
    one = mmbrdf.plot.reflectance_factor(ptfe, 532, views=[(-30, 180)], bands=False)
    other = mmbrdf.plot.reflectance_factor(ptfe, 532, views=[(30, 0)], bands=False)
    np.testing.assert_allclose(one[1].lines[0].get_ydata(), other[1].lines[0].get_ydata(), rtol=1e-12)
    assert "source side" in written(one[0]) and "source side" in written(other[0])
    with pytest.raises(ValueError, match="must not be negative"):
        mmbrdf.plot.in_plane_curves(ptfe, 532, -45)


def test_orientations_differ_by_a_quarter_turn_at_most(ptfe):
    _, axes = mmbrdf.plot.map(
        ptfe,
        "orientation_deg",
        532,
        45,
        minus=mmbrdf.material("ptfe-532"),
        stokes=(1, 0, 0, 0),
        samples=SAMPLES,
    )
    assert np.abs(axes.images[0].get_array()).max() <= 90


def test_what_makes_no_curve_and_no_band_is_refused(ptfe):
    plot = mmbrdf.plot
    for wrong, match in [
        (lambda: plot.reflectance_factor(ptfe, 532, theta_i_deg=[45]), "two values"),
        (lambda: plot.reflectance_against_angle(ptfe, 532, theta_i_deg=[45]), "two values"),
        (lambda: plot.reflectance_against_wavelength(ptfe, [532]), "two values"),
        (lambda: plot.reflectance_factor(ptfe, 532, coverage=float("nan")), "coverage"),
        (lambda: plot.in_plane_curves(ptfe, 532, coverage=-1), "coverage"),
        (lambda: plot.map(ptfe, "11", 532, 45, terms={"scale": 0.003}), "terms"),
    ]:
        with pytest.raises(ValueError, match=match):
            wrong()
