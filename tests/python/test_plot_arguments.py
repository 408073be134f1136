# SPDX-License-Identifier: BSD-3-Clause
"""What mmbrdf.plot takes and refuses, and how it shows names that others chose."""

import io
import warnings

import numpy as np
import pytest
from matplotlib.figure import Figure

import mmbrdf
import mmbrdf.plot
from mmbrdf.plot import labels
from pictures import SAMPLES, rendered, written

# Arguments


def test_other_things_than_models_and_samples_are_refused_in_a_line(ptfe, data):
    fitted, plot = mmbrdf.fit(data, orders=(1, 1)), mmbrdf.plot
    hint = r"expected mmbrdf\.Model, not FitResult: its \.model is one$"
    for draw, message in (
        (lambda: plot.in_plane_curves(fitted, 532), "^plot.in_plane_curves: model: " + hint),
        (lambda: plot.polar_in_plane([ptfe, fitted], 532), "^models: " + hint),
        (
            lambda: plot.polar_in_plane(fitted, 532),
            r"^plot.polar_in_plane: models: expected mmbrdf.Model or a sequence, not FitR",
        ),
        (lambda: plot.subset_study([fitted], ptfe, 532), "^parts: " + hint),
        (lambda: plot.subset_study([ptfe], fitted, 532), "^plot.subset_study: reference: " + hint),
        (lambda: plot.coefficient_spectrum(fitted), "^plot.coefficient_spectrum: model: " + hint),
        (
            lambda: plot.residual_map(data, ptfe, 532, 45),
            r"^plot.residual_map: model: expected mmbrdf\.Model, not Dataset$",
        ),
        (
            lambda: plot.residual_map(ptfe, fitted, 532, 45),
            r"^plot.residual_map: data: expected mmbrdf\.Dataset, not FitResult$",
        ),
        (
            lambda: plot.hemisphere(fitted, 532, 45),
            r"^plot.hemisphere: source: expected mmbrdf\.Model or mmbrdf\.Dataset, not FitResult: its",
        ),
        (
            lambda: plot.depolarization_map("ptfe", 532, 45),
            r"^plot.depolarization_map: source: expected .* not str 'ptfe'$",
        ),
        (lambda: plot.realizability_map(None, 532, 45), r"^plot.realizability_map: source: expected .* not NoneType$"),
        (
            lambda: plot.hemisphere(ptfe, "532", 45),
            "^plot.hemisphere: wavelength_nm: expected a number, not str '532'$",
        ),
        (
            lambda: plot.hemisphere(ptfe, [532, 633], 45),
            "^plot.hemisphere: wavelength_nm: expected a number, not list$",
        ),
        (
            lambda: plot.in_plane_curves(ptfe, 532, None),
            "^plot.in_plane_curves: theta_i_deg: expected a number, not NoneType$",
        ),
    ):
        with pytest.raises(TypeError, match=message):
            draw()
    with pytest.raises(ValueError, match="^theta_i_deg = nan, must be finite$"):
        plot.hemisphere(data, 532, np.nan)


def test_masked_abscissae_are_refused(ptfe):
    hidden = np.ma.masked_array([10.0, 20.0, 30.0], [False, True, False])
    for draw, name in (
        (lambda: mmbrdf.plot.in_plane_curves(ptfe, 532, theta_r_deg=hidden), "theta_r_deg"),
        (lambda: mmbrdf.plot.uncertainty_parts(ptfe, 532, 45, theta_r_deg=hidden), "theta_r_deg"),
        (lambda: mmbrdf.plot.uncertainty_parts(ptfe, 532, hidden, quantity="dhr"), "theta_i_deg"),
        (lambda: mmbrdf.plot.reflectance_against_angle(ptfe, 532, theta_i_deg=hidden), "theta_i_deg"),
        (lambda: mmbrdf.plot.hemisphere(ptfe, 532, np.ma.masked), "theta_i_deg"),
    ):
        with pytest.raises(ValueError, match=f"^{name}: a part of it is masked; leave it out$"):
            draw()


def test_none_is_the_wavelength_of_a_model_or_of_samples_that_have_one(data, tmp_path):
    model, plot = mmbrdf.material("ptfe-532"), mmbrdf.plot
    for draw in (
        lambda nm: plot.hemisphere(model, nm, 60, samples=SAMPLES),
        lambda nm: plot.hemisphere(data, nm, 60),
        lambda nm: plot.residual_map(model, data, nm, 60),
        lambda nm: plot.depolarization_map(model, nm, 60, samples=SAMPLES),
        lambda nm: plot.realizability_map(model, nm, 60, samples=SAMPLES),
        lambda nm: plot.in_plane_curves(model, nm),
        lambda nm: plot.subset_study([model], model, nm),
        lambda nm: plot.polar_in_plane(model, nm),
    ):
        np.testing.assert_array_equal(rendered(draw(None)[0]), rendered(draw(532)[0]))


def test_a_model_that_does_not_say_its_one_wavelength_needs_none(tmp_path):
    mmbrdf.in_published_form(mmbrdf.material("ptfe-532")).save(tmp_path / "model.csv")
    model = mmbrdf.load(tmp_path / "model.csv")
    figure, axes = mmbrdf.plot.in_plane_curves(model, None)
    assert axes.get_title().startswith(r"model, $\theta") and " nm" not in written(figure)
    figure, _ = mmbrdf.plot.hemisphere(model, None, 45, samples=SAMPLES)
    assert " nm" not in written(figure)


def test_none_of_several_wavelengths_is_refused_with_those_there_are(ptfe):
    two = mmbrdf.simulate(ptfe, [351, 532], mmbrdf.Geometry(45, 180, 30, 0))
    for source, message in ((ptfe, "the model depends on the wavelength, fitted at 351, 532"), (two, "at 351, 532 nm")):
        with pytest.raises(ValueError, match=message):
            mmbrdf.plot.hemisphere(source, None, 45, samples=SAMPLES)
    with pytest.raises(ValueError, match="the model depends on the wavelength"):
        mmbrdf.plot.in_plane_curves(ptfe, None)


# Names that others chose


def pictures_with_names(model, data):
    """All pictures that show the name of a model."""
    plot = mmbrdf.plot
    yield plot.hemisphere(model, 532, 60, samples=SAMPLES)[0]
    yield plot.residual_map(model, data, 532, 60)[0]
    yield plot.in_plane_curves(model, 532)[0]
    yield plot.subset_study([model], model, 532)[0]
    yield plot.polar_in_plane(model, 532)[0]
    yield plot.coefficient_spectrum(model)[0]
    yield plot.map(model, "11", 532, 60, samples=SAMPLES)[0]
    yield plot.reflectance_factor(model, 532, bands=False)[0]
    yield plot.reflectance_against_wavelength(model, bands=False)[0]
    yield plot.anisotropy(model)[0]


@pytest.mark.parametrize("name", [r"_hidden a\$b 纸样", r"cost $5 or $6 _{ $\frac$"])
def test_a_name_is_shown_letter_by_letter(ptfe, data, name, caplog):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for figure in pictures_with_names(ptfe.renamed(name), data):
            rendered(figure)
            figure.savefig(io.BytesIO(), bbox_inches="tight")
            assert name.replace("$", r"\$") in written(figure)
    assert caplog.records == []


def test_a_dollar_is_one_dollar():
    figure = Figure()
    shown = figure.text(0.5, 0.5, labels.plain("a$b$c"))
    literal = figure.text(0.5, 0.5, "a$b$c", parse_math=False)
    rendered(figure)
    assert shown.get_window_extent().width == literal.get_window_extent().width


def test_a_name_that_begins_with_a_low_line_is_in_the_legend(ptfe):
    figure, axes = mmbrdf.plot.polar_in_plane(ptfe.renamed("_hidden"), 532)
    assert [text.get_text().strip() for text in axes.get_legend().get_texts()][0] == "_hidden, 532 nm"
