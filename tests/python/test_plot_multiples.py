# SPDX-License-Identifier: BSD-3-Clause
"""Small multiples for wavelengths, and residuals at samples of any directions."""

import numpy as np
import pytest

import mmbrdf

pytest.importorskip("matplotlib")

import mmbrdf.plot as plot  # noqa: E402
from pictures import rendered, written  # noqa: E402
from test_plot_colours import drawn, unlike  # noqa: E402


@pytest.fixture(scope="module")
def random_data(ptfe):
    return mmbrdf.simulate(ptfe, [351, 532], mmbrdf.random_geometries(300, seed=1), speckle=0.01, seed=2)


def test_all_wavelengths_of_the_fit_have_a_column_and_the_same_scales(ptfe):
    figure, axes = plot.by_wavelength(ptfe, samples=21)
    assert axes.shape == (3, len(ptfe.wavelengths_nm))
    assert [each.get_title() for each in axes[0]] == ["351 nm", "532 nm", "633 nm", "1064 nm"]
    for row in axes[:2]:
        assert len({(each.images[0].norm.vmin, each.images[0].norm.vmax) for each in row}) == 1
    assert len({each.get_ylim() for each in axes[2]}) == 1
    assert "ptfe" in written(figure) and "$k$ = 2" in written(figure)


def test_its_maps_and_curves_are_those_of_the_model_at_each_wavelength(ptfe):
    _, axes = plot.by_wavelength(ptfe, [351, 1064], 30, samples=21)
    for nm, column in zip((351, 1064), axes.T):
        _, alone = plot.map(ptfe, "11", nm, 30, samples=21)
        np.testing.assert_array_equal(column[0].images[0].get_array(), alone.images[0].get_array())
        _, curves = plot.in_plane_curves(ptfe, nm, 30)
        for line, other in zip(column[2].lines, curves.lines):
            np.testing.assert_array_equal(line.get_ydata(), other.get_ydata())
        assert unlike(drawn(column[2])) is True


def test_wavelengths_beyond_the_fit_are_said_to_be_so(ptfe):
    figure, _ = plot.by_wavelength(ptfe, [443, 2100], samples=21)
    assert "443 nm, interpolated" in written(figure) and "2100 nm, beyond the fit" in written(figure)


def f11_alone(data):
    """The same of which no other element was measured."""
    mueller = np.full((len(data), 4, 4), np.nan)
    mueller[:, 0, 0] = data.f11
    return mmbrdf.Dataset(data.wavelength_nm, *data.geometry, mueller)


def places(figure):
    """Of the words of titles, labels and legends."""
    rendered(figure)
    labels = [label for axes in figure.axes for label in (axes.title, axes.xaxis.label, axes.yaxis.label)]
    legends = [text for legend in figure.legends for text in legend.get_texts()]
    words = [text for text in [*labels, *legends, *figure.texts, figure._supxlabel] if text and text.get_text().strip()]
    return {text.get_text(): text.get_window_extent() for text in words if text.get_visible()}


@pytest.mark.parametrize("width_cm", [8, 12, 17, None])
def test_words_beside_four_wavelengths_neither_meet_nor_leave_the_figure(ptfe, width_cm):
    data = mmbrdf.simulate(ptfe, ptfe.wavelengths_nm, mmbrdf.random_geometries(40, seed=1), speckle=0.01, seed=2)
    for figure, _ in (
        plot.by_wavelength(ptfe, samples=21, width_cm=width_cm),
        plot.residuals(ptfe, data, width_cm=width_cm),
    ):
        found = places(figure)
        assert len(found) > 6
        for name, place in found.items():
            assert place.x0 >= 0 and place.y0 >= 0 and place.x1 <= figure.bbox.x1 and place.y1 <= figure.bbox.y1, name
            assert not [other for other, at in found.items() if other != name and at.overlaps(place)], name


def test_what_was_not_measured_has_no_row(samples):
    model = mmbrdf.fit(f11_alone(samples), orders=(3, 2)).model
    assert plot.by_wavelength(model, samples=21)[1].shape == (1, 1)


def test_a_figure_is_as_wide_as_a_page_asks_for(ptfe, random_data):
    for figure, _ in (
        plot.by_wavelength(ptfe, samples=21, width_cm=17),
        plot.residuals(ptfe, random_data, width_cm=17),
    ):
        assert figure.get_figwidth() == pytest.approx(17 / 2.54)
        rendered(figure)


def points(axes):
    return np.asarray(axes.collections[0].get_offsets())


def test_residuals_are_measured_less_model_at_each_sample(ptfe, random_data):
    _, axes = plot.residuals(ptfe, random_data)
    assert axes.shape == (2, 2)
    for nm, column in zip((351, 532), axes.T):
        here = random_data.at_wavelengths(nm)
        predicted = ptfe.evaluate(nm, *here.geometry)
        forward = np.cos(np.radians(here.phi_r_deg - here.phi_i_deg)) <= 1e-6
        np.testing.assert_allclose(points(column[0])[:, 0], np.where(forward, 1, -1) * here.theta_r_deg)
        relative = 100 * (here.mueller[:, 0, 0] / predicted[:, 0, 0] - 1)
        np.testing.assert_allclose(points(column[0])[:, 1], relative, atol=1e-9)
        left = here.mueller / here.f11[:, None, None] - predicted / predicted[:, :1, :1]
        rms = np.sqrt((left.reshape(-1, 16)[:, 1:] ** 2).mean(axis=1))
        np.testing.assert_allclose(points(column[1])[:, 1], rms, atol=1e-12)
        lines = sorted(float(np.ravel(line.get_ydata())[0]) for line in column[0].lines)
        assert lines == pytest.approx([-np.sqrt(np.mean(relative**2)), 0, np.sqrt(np.mean(relative**2))])


def test_residuals_of_f11_alone_have_one_row(ptfe, random_data):
    assert plot.residuals(ptfe, f11_alone(random_data))[1].shape == (1, 2)


def test_wrong_things_are_refused_in_a_line(ptfe, random_data):
    with pytest.raises(TypeError, match="^plot.residuals: data: expected mmbrdf.Dataset, not Model$"):
        plot.residuals(ptfe, ptfe)
    with pytest.raises(TypeError, match="^plot.by_wavelength: model: expected mmbrdf.Model, not Dataset$"):
        plot.by_wavelength(random_data)
    with pytest.raises(ValueError, match="^no samples at 633 nm$"):
        plot.residuals(ptfe, random_data, 633)
