# SPDX-License-Identifier: BSD-3-Clause
"""What stands for different things in a picture is told apart by deuteranopes, by protanopes and in grey prints."""

import itertools

import numpy as np
import pytest
from matplotlib import colormaps
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_hex

import mmbrdf
import mmbrdf.plot
from mmbrdf.plot import colours
from pictures import SAMPLES
from vision import AS_SEEN, cielab, distance, linear

FAR = 10.0
"""Units of CIELAB that lines of one style must be apart: four times what is just noticeable on large areas."""


def look(line):
    """What tells a line or marker apart besides its colour."""
    dashes = line._unscaled_dash_pattern if line.get_linestyle() != "None" else "no line"
    thick = "no line" if dashes == "no line" else round(np.log2(line.get_linewidth()))
    hollow = line.get_markerfacecolor() in ("none", "white")
    return str(dashes), thick, str(line.get_marker()), hollow


def drawn(axes):
    """Colour and look of lines that stand for something: those with a name, or those of curves."""
    return [(to_hex(line.get_color()), look(line)) for line in axes.lines if len(line.get_xdata()) > 2]


def unlike(pairs):
    """Whether these can be told apart however they are seen; else which cannot."""
    for (one, look_one), (other, look_other) in itertools.combinations(dict.fromkeys(pairs), 2):
        for seen in AS_SEEN:
            if look_one == look_other and distance(one, other, seen) < FAR:
                return f"{one} and {other}, {seen}"
    return True


def figures_with_lines(ptfe, goniometer_files):
    plot, single = mmbrdf.plot, mmbrdf.material("ptfe-532")
    nm = [351, 532, 633, 1064]
    yield "in_plane_curves", plot.in_plane_curves(ptfe, 532)[1]
    yield "in_plane_curves, one style", plot.in_plane_curves(ptfe, 532, linestyle="-")[1]
    yield "subset_study", plot.subset_study([single], ptfe, 532)[1]
    yield "polar_in_plane", plot.polar_in_plane(ptfe, nm)[1]
    yield "reflectance_factor", plot.reflectance_factor(ptfe, nm, views=[(0, 0), (30, 180)], bands=False)[1]
    yield "reflectance_against_angle", plot.reflectance_against_angle(ptfe, nm, bands=False)[1]
    angles = dict(theta_i_deg=[8, 45, 60], bands=False)
    yield "reflectance_against_wavelength", plot.reflectance_against_wavelength(ptfe, nm, **angles)[1]
    yield "anisotropy", plot.anisotropy(ptfe)[1]
    instrument, references, film = goniometer_files
    yield "calibration", plot.calibration(instrument, references, film=film)[1][1]
    yield "plan", plot.plan(mmbrdf.plan({"grid": mmbrdf.germer2017_grid(), "b": mmbrdf.random_geometries(60, seed=1)}))[
        1
    ]


@pytest.fixture(scope="module")
def goniometer_files(tmp_path_factory):
    path = tmp_path_factory.mktemp("references") / "references.csv"
    goniometer = mmbrdf.Goniometer(seed=1)
    goniometer.write_references(path, 532)
    return mmbrdf.calibrate(path, film=goniometer.film), path, goniometer.film


def test_lines_of_each_figure_are_told_apart_without_red_and_green_and_in_grey(ptfe, goniometer_files):
    for name, axes in figures_with_lines(ptfe, goniometer_files):
        lines = drawn(axes)
        assert len(set(lines)) > 1, name
        assert unlike(lines) is True, name


def test_red_and_green_lines_of_one_style_would_not_pass():
    plain = ("-", 1, "None", False)
    assert unlike([("#d62728", plain), ("#2ca02c", plain)]) != True  # noqa: E712: else it is the pair
    assert unlike([("#d62728", plain), ("#2ca02c", ("--", 1, "None", False))]) is True


def test_simulated_sight_keeps_white_and_grey_and_merges_what_it_must():
    for seen, matrix in AS_SEEN.items():
        np.testing.assert_allclose(matrix @ np.ones(3), 1, atol=2e-6)
        np.testing.assert_allclose(cielab(matrix @ linear("0.5"))[1:], 0, atol=0.05)
    assert cielab(np.ones(3))[0] == pytest.approx(100) and cielab(np.zeros(3))[0] == pytest.approx(0, abs=1e-12)
    # sRGB red and green of the same luminance: far apart for most, one colour in grey.
    assert distance("#ff0000", "#009400", "all cones") > 100 and distance("#ff0000", "#009400", "grey") < 2
    assert distance("#d62728", "#2ca02c", "deuteranopia") < 10 < 100 < distance("#d62728", "#2ca02c", "all cones")


def test_parts_of_an_uncertainty_differ_in_colour_or_hatch(ptfe):
    _, axes = mmbrdf.plot.uncertainty_parts(ptfe, 532, terms={"calibration": 0.002})
    bodies = [each for each in axes.collections if isinstance(each, PolyCollection)]
    assert len(bodies) >= 4
    assert unlike([(to_hex(body.get_facecolor()[0]), (body.get_hatch(),)) for body in bodies]) is True


@pytest.mark.parametrize("name", [colours.VALUES, colours.SIGNED, "gray"])
def test_maps_grow_lighter_all_the_way_however_they_are_seen(name):
    shades = colormaps[name](np.linspace(0, 1, 33))
    for seen, matrix in AS_SEEN.items():
        lightness = [cielab(matrix @ linear(shade[:3]))[0] for shade in shades]
        assert (np.diff(lightness) > 0.5).all(), seen


def test_zero_of_a_signed_map_is_grey_between_darker_blue_and_lighter_yellow(ptfe):
    _, axes = mmbrdf.plot.map(ptfe, "12", 532, 60, samples=SAMPLES)
    (image,) = axes.images
    low, high = image.get_clim()
    assert low == -high
    red, green, blue, _ = image.cmap(image.norm(0.0))
    assert max(red, green, blue) - min(red, green, blue) < 0.03
    assert image.cmap(0.0)[2] > 2 * image.cmap(0.0)[0] and image.cmap(1.0)[0] > 2 * image.cmap(1.0)[2]


def test_series_of_up_to_six_are_told_apart_by_colour_alone_but_for_neighbours():
    for count in range(2, 7):
        strokes = colours.series(count)
        assert unlike([(stroke.color, (str(stroke.style), stroke.marker)) for stroke in strokes]) is True
        lightness = [cielab(linear(stroke.color))[0] for stroke in strokes]
        assert lightness == sorted(lightness)
        assert lightness[-1] < 80, "still seen on white"
