# SPDX-License-Identifier: BSD-3-Clause
"""examples/paper: the figures and numbers, from simulated data everywhere and from the published where they are."""
import csv
import io
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgba
from matplotlib.image import imread

import mmbrdf

root = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(root / "examples" / "paper"))

import drawing  # noqa: E402
import figures  # noqa: E402
import report  # noqa: E402
import study as studies  # noqa: E402
from study import ALL, ISOTROPIC, PUBLISHED  # noqa: E402


@pytest.fixture(scope="module")
def simulated():
    return studies.load(None)


@pytest.fixture(scope="module")
def published_study(published):
    return studies.load(published)


def written(figure):
    return " ".join(text.get_text() for text in figure.findobj(lambda artist: hasattr(artist, "get_text")))


# Without the published data


def test_a_folder_without_the_published_data_gives_simulated_ones_of_the_same_shape(tmp_path):
    study = studies.load(tmp_path)
    assert study.simulated
    assert len(study.grid) == 7296 and len(study.random) == 1760
    assert study.grid.wavelengths_nm == studies.WAVELENGTHS_NM


def test_simulated_figures_and_their_report_say_so(simulated, tmp_path):
    figure = drawing.subset_figure(simulated, ISOTROPIC)
    figures.write_figure(figure, tmp_path / "fig7", simulated=True)
    assert "simulated data" in written(figure)
    assert (tmp_path / "fig7.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "fig7.pdf").read_bytes().startswith(b"%PDF")
    report.write(simulated, tmp_path)
    assert "**The data are simulated**" in (tmp_path / "report.md").read_text(encoding="utf-8")


def test_the_remark_on_simulated_data_can_be_seen_beside_subfigures(simulated, tmp_path):
    figure = drawing.matrix_figure(simulated, ISOTROPIC, 532.0, samples=5)
    figures.write_figure(figure, tmp_path / "fig2", simulated=True)
    corner = imread(tmp_path / "fig2.png")[-30:, -200:]
    red = (corner[..., 0] > 0.6) & (corner[..., 1] < 0.3) & (corner[..., 2] < 0.3)
    assert red.sum() > 100


def test_the_program_writes_what_it_is_asked_for(tmp_path, capsys):
    assert figures.main([str(tmp_path / "nothing"), str(tmp_path / "out"), "--only", "fig6", "fourfold"]) == 0
    found = sorted(str(path.relative_to(tmp_path / "out")) for path in (tmp_path / "out").rglob("*.*"))
    assert found == [
        "fig6.pdf",
        "fig6.png",
        "isotropic/fig6.pdf",
        "isotropic/fig6.png",
        "isotropic/fourfold.pdf",
        "isotropic/fourfold.png",
    ]
    assert "simulating" in capsys.readouterr().out


def test_names_of_figures_are_fixed():
    assert [name for name, _ in drawing.figures(PUBLISHED)] == [f"fig{number}" for number in range(1, 8)]
    assert [name for name, _ in drawing.figures(ISOTROPIC)][7:] == ["fourfold", "random_directions"]
    with pytest.raises(SystemExit):
        figures.main(["nothing", "out", "--only", "fig9"])


def test_the_picture_of_the_readme_is_small(tmp_path):
    assert figures.main(["--readme", str(tmp_path / "hemisphere.png")]) == 0
    assert 10_000 < (tmp_path / "hemisphere.png").stat().st_size < 150_000


def test_what_cannot_be_done_is_said_in_a_line(simulated, tmp_path, capsys):
    data, file = tmp_path / "data", tmp_path / "file"
    garbage, empty, others = (tmp_path / name for name in ("garbage", "empty", "others"))
    for folder in (data, garbage, empty, others):
        folder.mkdir()
    file.write_text("")
    simulated.grid.save(data / "PTFE.data.csv")
    (garbage / "PTFE.data.csv").write_bytes(bytes(range(256)))
    (empty / "PTFE.data.csv").write_text("")
    simulated.random.save(others / "PTFE.data.csv")
    out = tmp_path / "out"
    for arguments, messages in (
        ((data, out), [str(data / "PTFE.data.random.csv"), "No such file"]),
        ((garbage, out), [str(garbage / "PTFE.data.csv")]),
        ((empty, out), [str(empty / "PTFE.data.csv")]),
        ((others, out), [f"{others / 'PTFE.data.csv'}: has samples at 532 nm, expected 351, 532, 633, 1064 nm"]),
        ((file, out), [f"{file}: not a folder"]),
        ((tmp_path / "nothing", file), [f"{file}: not a folder"]),
        (("--readme", file / "picture.png"), [str(file)]),
    ):
        assert figures.main([str(argument) for argument in arguments]) == 1
        printed = capsys.readouterr()
        assert printed.err.count("\n") == 1 and printed.out == ""
        for message in messages:
            assert message in printed.err
    assert not out.exists()


# What is in the figures


def test_figures_1_to_4_have_a_column_for_each_angle_and_measured_over_fitted(simulated):
    figure = drawing.matrix_figure(simulated, ISOTROPIC, 633.0, samples=15)
    images = [axes.images[0] for axes in figure.axes if axes.images]
    assert len(images) == 2 * 6 * 16
    assert all(image.get_clim() == (0.25, 0.45) for image in images[::16])
    assert all(image.get_clim() == (-0.1, 0.1) for number, image in enumerate(images) if number % 16)
    measured, fitted = images[:96], images[96:]
    for column, theta_i_deg in enumerate(studies.INCIDENT_DEG):
        at_angle = simulated.grid.at_wavelengths([633])
        at_angle = at_angle[np.isclose(at_angle.theta_i_deg, theta_i_deg, atol=0.01)]
        np.testing.assert_array_equal(np.sort(measured[16 * column].get_array().compressed()), np.sort(at_angle.f11))
        centre = simulated.model(ISOTROPIC, ALL).evaluate(633, theta_i_deg, 180, 0, 0)
        shown = [image.get_array()[7, 7] for image in fitted[16 * column : 16 * column + 16]]
        expected = (centre / centre[0, 0]).ravel()
        expected[0] = centre[0, 0]
        np.testing.assert_allclose(shown, expected, atol=1e-14)
    text = written(figure)
    for expected in ("simulated", "fit (isotropic)", "633 nm", "75°", "sr$^{-1}$"):
        assert expected in text


def test_figure_5_has_three_wavelengths_at_two_angles(simulated):
    figure = drawing.depolarization_figure(simulated, PUBLISHED, samples=21)
    maps = [axes for axes in figure.axes if axes.images]
    titles = [axes.get_title() for axes in maps]
    assert [title.split(" nm")[0] for title in titles] == ["351", "532", "1064"] * 2
    assert all("0°" in title and "60°" not in title for title in titles[:3])
    assert all("60°" in title for title in titles[3:])
    model = simulated.model(PUBLISHED, ALL)
    for axes, wavelength_nm in zip(maps, (351, 532, 1064)):
        centre = mmbrdf.depolarization(model.evaluate(wavelength_nm, 0, 180, 0, 0))
        assert axes.images[0].get_array()[10, 10] == pytest.approx(centre, abs=1e-14)


def test_figure_6_has_the_papers_colours_styles_and_widths(simulated):
    (axes,) = drawing.curves_figure(simulated, PUBLISHED).axes
    assert len(axes.lines) == 32
    colours = [to_rgba(line.get_color())[:3] for line in axes.lines]
    assert colours == 8 * colours[:4]
    assert colours[0] == (0, 0, 0)
    assert [int(np.argmax(colour)) for colour in colours[1:4]] == [0, 1, 2]  # red, green, blue
    for number, (wavelength_nm, style) in enumerate(drawing.LINE_STYLES.items()):
        thin, thick = axes.lines[8 * number : 8 * number + 4], axes.lines[8 * number + 4 : 8 * number + 8]
        assert max(line.get_linewidth() for line in thin) < 0.5 * min(line.get_linewidth() for line in thick)
        angles = thick[0].get_xdata()
        at = angles == 30
        curve = mmbrdf.polarized_curve(simulated.model(PUBLISHED, ALL), wavelength_nm, mmbrdf.in_plane(45, 30.0))
        np.testing.assert_allclose([line.get_ydata()[at][0] for line in thick], np.array(curve).ravel(), rtol=1e-13)


def test_figure_6_has_a_style_for_each_wavelength(simulated):
    axes = drawing.curves_figure(simulated, PUBLISHED).axes[0]
    drawn = io.BytesIO()
    for number, line in enumerate(axes.lines):
        line.set_gid(f"curve-{number}")
    axes.figure.savefig(drawn, format="svg")
    curves = re.findall(r'<g id="curve-(\d+)">\s*<path [^>]*style="([^"]*)"', drawn.getvalue().decode())
    assert [int(number) for number, _ in curves] == list(range(32))
    on_and_off = []
    for number, style in curves:
        found = re.search(r"stroke-dasharray: ([\d., ]+)", style)
        width = axes.lines[int(number)].get_linewidth()
        on_and_off.append([float(part) / width for part in found.group(1).split(",")] if found else [])
    solid, dashed, dash_dot_dot, dash_dot = (on_and_off[8 * n : 8 * n + 8] for n in range(4))
    assert solid == [[]] * 8
    assert all(len(pattern) == 2 for pattern in dashed)
    for pattern in dash_dot_dot:
        dash, *_ = pattern
        assert len(pattern) == 6 and pattern[2] < dash / 3 and pattern[4] < dash / 3
    assert all(len(pattern) == 4 and pattern[2] < pattern[0] / 3 for pattern in dash_dot)


# Four-fold pattern


def test_the_four_fold_pattern_is_there_with_the_published_basis_only(simulated):
    # The simulated sample is isotropic: the published basis takes its noise for a pattern, the other cannot.
    amplitudes = {
        basis: [
            studies.fourfold_amplitude(simulated.model(basis, ALL), wavelength_nm)
            for wavelength_nm in studies.WAVELENGTHS_NM
        ]
        for basis in (PUBLISHED, ISOTROPIC)
    }
    assert max(amplitudes[PUBLISHED]) > 1e-4
    assert max(amplitudes[ISOTROPIC]) < 1e-12


def test_the_depolarization_of_the_isotropic_basis_is_constant_around_the_normal(simulated):
    for wavelength_nm in studies.WAVELENGTHS_NM:
        for theta_r_deg in (20.0, 50.0, 80.0):
            _, values = studies.depolarization_around(simulated.model(ISOTROPIC, ALL), wavelength_nm, theta_r_deg)
            assert np.ptp(values) < 1e-12


@pytest.mark.parametrize("wavelength_nm, amplitude", [(351.0, 0.0046), (532.0, 0.0033), (633.0, 0.0027)])
def test_the_papers_four_fold_pattern_appears_with_its_basis_only(published_study, wavelength_nm, amplitude):
    found = studies.fourfold_amplitude(published_study.model(PUBLISHED, ALL), wavelength_nm)
    assert found == pytest.approx(amplitude, abs=0.0001)
    assert studies.fourfold_amplitude(published_study.model(ISOTROPIC, ALL), wavelength_nm) < 1e-12


# Numbers


def test_pooled_is_the_rms_over_elements():
    by_element = np.zeros((4, 4))
    by_element[0, 0], by_element[0, 1], by_element[1, 0] = 100, 3, 1
    assert report.pair_rms(by_element, "12") == pytest.approx(np.sqrt(5))
    assert studies.pooled(by_element) == pytest.approx(np.sqrt(10 / 15))
    assert report.pair_rms(by_element, "11") == 100


def test_subset_numbers_of_known_curves():
    def depolarizer(slope):
        """f11 = 0.3 (1 + slope cos(theta_i) cos(theta_r)), whose four curves are half of it."""
        geometry = mmbrdf.random_geometries(500, seed=1)
        cosines = np.cos(np.radians(geometry.theta_i_deg)) * np.cos(np.radians(geometry.theta_r_deg))
        mueller = 0.3 * (1 + slope * cosines)[:, None, None] * np.diag([1.0, 0, 0, 0])
        return mmbrdf.fit(mmbrdf.Dataset(532, *geometry, mueller), orders=(2, 2)).model

    numbers = studies.subset_numbers([depolarizer(slope) for slope in (0.0, 0.02, 0.07)], depolarizer(0.0))
    # At theta_i = 45 degrees, in percent: the mean of the parts is 3 cos(theta_r) / sqrt(2) above the reference. Their
    # slopes are 3, 1 and 4 off their mean: standard deviation sqrt((9 + 1 + 16) / 2). The sum of cosines over -60 ... 60
    # degrees is sin(60.5) / sin(0.5), the largest is 1.
    mean_cosine = np.sin(np.radians(60.5)) / np.sin(np.radians(0.5)) / 121
    assert numbers == pytest.approx(
        {
            "mean_distance": 3 / np.sqrt(2) * mean_cosine,
            "largest_distance": 3 / np.sqrt(2),
            "deviation": np.sqrt(26 / 2) / np.sqrt(2) * mean_cosine,
        },
        rel=1e-9,
    )


def test_refitting_gives_the_published_coefficients(published, published_study):
    for which, path in report.published_fits(published):
        difference = studies.largest_coefficient_difference(
            published_study.model(PUBLISHED, which), mmbrdf.load_model(path)
        )
        assert difference < 1e-11


def test_the_papers_subset_numbers_come_out(published_study):
    # Section 5: 0.59 %, 2.6 %, 0.52 %; with more digits theory.md.
    numbers = studies.subset_numbers(published_study.parts(PUBLISHED), published_study.model(PUBLISHED, 532.0))
    assert numbers["mean_distance"] == pytest.approx(0.5925, abs=5e-5)
    assert numbers["largest_distance"] == pytest.approx(2.6364, abs=5e-5)
    assert numbers["deviation"] == pytest.approx(0.5201, abs=5e-5)


def test_the_papers_residuals_come_out_to_the_digits_it_states(published_study):
    found = {row[0]: row[3] for row in studies.rms_table(published_study) if row[1] == ALL and row[2] == "351-1064"}
    for _, stated, elements in report.STATED_RMS:
        ours = found[PUBLISHED][0, 0] if elements is None else studies.pooled(found[PUBLISHED], elements)
        assert round(ours, 3) == stated


def test_tables_hold_what_the_study_says(published_study, tmp_path):
    report.write(published_study, tmp_path)
    with (tmp_path / "random_directions.csv").open(newline="") as file:
        rows = {row["way"]: float(row["all_but_11"]) for row in csv.DictReader(file)}
    assert rows == pytest.approx(
        {"germer2017, as printed": 0.01753, "germer2017, turned": 0.01134, "isotropic": 0.01131}, abs=5e-6
    )
    with (tmp_path / "reflectance.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["basis"] == PUBLISHED and row["fit"] == "one wavelength"]
    assert [float(row["dhr_0"]) for row in rows] == pytest.approx([0.975147, 0.984159, 0.984413, 0.983339], abs=1e-6)
    assert [float(row["bhr"]) for row in rows] == pytest.approx([0.985510, 0.983263, 0.983781, 0.983979], abs=1e-6)
    text = (tmp_path / "report.md").read_text(encoding="utf-8")
    assert "simulated" not in text and "0.5925 %" in text and "2.6364 %" in text and "0.5201 %" in text
