# SPDX-License-Identifier: BSD-3-Clause
"""The report page: complete, self-contained, and shown by a browser."""

import html.parser
import json
import os
import re
import shutil
import stat
import subprocess
import sys

import numpy as np
import pytest

import mmbrdf

pytest.importorskip("matplotlib")

from mmbrdf import _report  # noqa: E402


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """A report on a fit to simulated data, as text and file."""
    folder = tmp_path_factory.mktemp("report")
    data = mmbrdf.simulate(mmbrdf.material("ptfe"), 532, mmbrdf.germer2017_grid(), speckle=0.01, seed=1)
    model = mmbrdf.fit(data, name="sample & co").model
    mmbrdf.report(model, data, folder / "report.html", data_name="<simulated>")
    return model, data, folder / "report.html"


@pytest.fixture
def short_page():
    return "<p>theta_i ≤ 75°</p>\n"


class Outline(html.parser.HTMLParser):
    """Headings, pictures and links of a page, and whether each element that was opened is closed."""

    def __init__(self, text):
        super().__init__()
        self.open, self.headings, self.pictures, self.links = [], [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        if tag not in ("meta", "img"):
            self.open.append(tag)
        for name, value in attributes:
            if name in ("src", "href"):
                (self.pictures if value.startswith("data:image/") else self.links).append(value)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, text):
        if self.open and self.open[-1] in ("h1", "h2"):
            self.headings.append(text)


def test_the_page_says_what_the_program_says(page):
    model, data, path = page
    facts = json.loads(mmbrdf.report_json(model, model.name, data=data))
    outline = Outline(path.read_text())
    assert outline.headings[0] == "Report on sample & co"
    for field in facts:
        if field not in ("title", "warnings"):
            assert field.capitalize().replace("_", " ") in outline.headings
    assert outline.open == []


def test_values_end_where_two_digits_of_their_uncertainty_end(page):
    number = r'<td class="number">(0\.0*[1-9]\d*)</td>'
    ((value, u),) = re.findall("<td>bhr</td>" + number + number, page[2].read_text())
    assert len(u.lstrip("0.")) == 2
    assert len(value) == len(u)


def test_the_facts_are_those_of_the_program(ptfe, program):
    printed = program("report", "ptfe", "--format", "json")
    assert json.loads(printed) == json.loads(mmbrdf.report_json(ptfe, "ptfe"))


def test_the_page_needs_nothing_else(page):
    outline = Outline(page[2].read_text())
    assert outline.links == []
    assert len(outline.pictures) == 7  # hemisphere, curves, realizability, coefficients, three maps of residuals
    assert not re.search(r"https?://(?!www\.w3\.org)", re.sub(r'src="data:[^"]*"', "", page[2].read_text()))


def test_names_are_text_and_not_markup(page):
    text = page[2].read_text()
    assert "sample &amp; co" in text and "&lt;simulated&gt;" in text and "<simulated>" not in text


def test_warnings_come_first(tmp_path):
    model = mmbrdf.in_published_form(mmbrdf.material("ptfe-532"))
    mmbrdf.report(model, None, tmp_path / "report.html", wavelength_nm=532)
    text = re.sub(r"<style>.*?</style>", "", (tmp_path / "report.html").read_text(), flags=re.DOTALL)
    assert (
        text.index('class="warnings"') < text.index("<h2>")
        and "the covariance of the coefficients is not known" in text
    )


def test_nothing_is_left_behind_by_an_error(page, tmp_path):
    model, _, _ = page
    with pytest.raises(FileNotFoundError):
        mmbrdf.report(model, None, tmp_path / "no/report.html")
    (tmp_path / "report.html").write_text("earlier")
    with pytest.raises(ValueError):
        mmbrdf.report(model, None, tmp_path / "report.html", wavelength_nm=-1)
    assert (tmp_path / "report.html").read_text() == "earlier"
    assert [path.name for path in tmp_path.iterdir()] == ["report.html"]


def test_other_things_than_a_model_and_samples_are_refused_in_a_line(page, tmp_path):
    model, data, _ = page
    fitted = mmbrdf.fit(data, orders=(1, 1))
    for arguments, message in (
        ((fitted, data), "model: expected mmbrdf.Model, not FitResult: its .model is one"),
        ((data, model), "model: expected mmbrdf.Model, not Dataset"),
        ((model, fitted), "data: expected mmbrdf.Dataset, not FitResult"),
        ((model, tmp_path), f"data: expected mmbrdf.Dataset, not {type(tmp_path).__name__}"),
    ):
        with pytest.raises(TypeError, match=f"^{re.escape(message)}$"):
            mmbrdf.report(*arguments, tmp_path / "report.html")
    for option, message in (
        ({"wavelength_nm": "532 nm"}, "wavelength_nm: expected a number, not '532 nm'"),
        ({"theta_i_deg": None}, "theta_i_deg: expected a number, not None"),
    ):
        with pytest.raises(TypeError, match=f"^{re.escape(message)}$"):
            mmbrdf.report(model, data, tmp_path / "report.html", **option)
    assert list(tmp_path.iterdir()) == []


def headings(path):
    return Outline(path.read_text()).headings


def test_published_coefficients_are_reported_on_at_the_wavelengths_of_the_samples(ptfe, tmp_path):
    mmbrdf.in_published_form(ptfe).save(tmp_path / "published.csv")
    model = mmbrdf.load(tmp_path / "published.csv")
    data = mmbrdf.simulate(ptfe, 633, mmbrdf.germer2017_grid(), speckle=0.01, seed=2)
    mmbrdf.report(model, data, tmp_path / "report.html")
    assert "The model at 633 nm" in headings(tmp_path / "report.html")
    with pytest.raises(ValueError, match="published does not say to which wavelengths it was fitted"):
        mmbrdf.report(model, None, tmp_path / "report.html")


def test_a_model_of_one_unknown_wavelength_is_not_said_to_have_one(tmp_path):
    mmbrdf.in_published_form(mmbrdf.material("ptfe-532")).save(tmp_path / "published.csv")
    mmbrdf.report(mmbrdf.load(tmp_path / "published.csv"), None, tmp_path / "report.html")
    assert "The model" in headings(tmp_path / "report.html")
    assert not re.search(r"\d nm", re.sub(r'src="data:[^"]*"', "", (tmp_path / "report.html").read_text()))


def azimuths(path):
    return re.findall(r"phi_i = (\S+) degrees", "".join(re.findall("<figcaption>.*?</figcaption>", path.read_text())))


def test_all_pictures_have_the_azimuth_of_the_samples_and_say_so(anisotropic, tmp_path):
    grid = mmbrdf.germer2017_grid()
    data = mmbrdf.simulate(
        anisotropic, 532, grid._replace(phi_i_deg=np.full(len(grid.theta_i_deg), 30.0)), speckle=0.01
    )
    mmbrdf.report(anisotropic, data, tmp_path / "report.html")
    assert (
        azimuths(tmp_path / "report.html") == ["30"] * 6
    )  # hemisphere, curves, realizability, three maps of residuals
    mmbrdf.report(anisotropic, None, tmp_path / "report.html")
    assert azimuths(tmp_path / "report.html") == ["180"] * 3


def test_the_pictures_are_drawn_at_the_azimuth_that_their_captions_name(anisotropic):
    pictures = [
        [part for part in _report._model_pictures(anisotropic, 532, 60, phi_i_deg) if "<img" in part]
        for phi_i_deg in (30, 180)
    ]
    sources = [[re.search('src="(.*?)"', part).group(1) for part in parts] for parts in pictures]
    assert len(sources[0]) == 3 and all(one != other for one, other in zip(*sources))


def test_samples_from_everywhere_have_no_azimuth(ptfe):
    assert _report._azimuth_deg(mmbrdf.simulate(ptfe, 532, mmbrdf.random_geometries(500, seed=1))) == 180
    grid = mmbrdf.germer2017_grid()
    turned = grid._replace(phi_i_deg=np.where(np.arange(len(grid.theta_i_deg)) % 3 > 0, 359.96, 90.0))
    assert _report._azimuth_deg(mmbrdf.simulate(ptfe, 532, turned)) == 0


def test_without_samples_the_message_says_where(page, tmp_path):
    model, data, _ = page
    with pytest.raises(ValueError, match=r"^empty\.csv: no samples$"):
        mmbrdf.report(model, data[:0], tmp_path / "report.html", data_name="empty.csv")
    data[:1].save(tmp_path / "empty.csv")
    (tmp_path / "empty.csv").write_text((tmp_path / "empty.csv").read_text().splitlines()[0] + "\n")
    done = run_module("ptfe-532", "empty.csv", "-o", "report.html", folder=tmp_path)
    assert done.returncode == 1 and "empty.csv" in done.stderr and done.stderr.count("\n") == 1


def test_a_missing_folder_is_named_as_it_was_given(page, tmp_path):
    with pytest.raises(FileNotFoundError) as error:
        mmbrdf.report(page[0], None, tmp_path / "no" / "report.html")
    assert error.value.filename == str(tmp_path / "no" / "report.html")


def test_a_link_is_followed_and_the_mode_of_the_file_is_kept(short_page, tmp_path):
    target, link = tmp_path / "target.html", tmp_path / "link.html"
    target.write_text("earlier")
    target.chmod(0o640)
    link.symlink_to("target.html")
    _report.write(link, short_page)
    assert link.is_symlink() and target.read_text() == short_page
    assert stat.S_IMODE(target.stat().st_mode) == 0o640


def test_pipes_and_devices_are_written_into_and_not_replaced(short_page, tmp_path):
    pipe, null = tmp_path / "pipe", tmp_path / "null"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    _report.write(pipe, short_page)
    assert os.read(reader, 1000).decode() == short_page
    os.close(reader)
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    null.symlink_to("/dev/null")
    _report.write(null, short_page)
    assert null.is_symlink()


def test_the_error_of_a_full_device_names_the_path_that_was_given(short_page, tmp_path):
    full = tmp_path / "full.html"
    full.symlink_to("/dev/full")
    with pytest.raises(OSError, match=f"^{re.escape(str(full))}: cannot be written: No space left on device$"):
        _report.write(full, short_page)


def run_module(*arguments, folder):
    command = [sys.executable, "-m", "mmbrdf.report", *map(str, arguments)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_it_runs_as_a_program(tmp_path):
    done = run_module("ptfe-532", "-o", "report.html", folder=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert "Report on ptfe-532" in (tmp_path / "report.html").read_text()
    for arguments, message in (
        (("nowhere.json", "-o", "other.html"), "nowhere.json"),
        (("ptfe-532", "report.html", "-o", "other.html"), "report.html"),
        (("ptfe-532", "-o", "no/other.html"), "no/"),
    ):
        done = run_module(*arguments, folder=tmp_path)
        assert done.returncode == 1 and message in done.stderr and done.stderr.count("\n") == 1
    assert not (tmp_path / "other.html").exists()


@pytest.mark.parametrize("name", ["$_{$.csv", "纸样.csv", "<i>&amp;.csv"])
def test_file_names_are_text_whatever_is_in_them(name, tmp_path):
    mmbrdf.in_published_form(mmbrdf.material("ptfe-532")).save(tmp_path / name)
    done = run_module(name, "-o", "report.html", folder=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert headings(tmp_path / "report.html")[0] == f"Report on {name}"


def test_it_prints_the_page_where_that_is_asked_for(tmp_path):
    done = run_module("ptfe-532", "-o", "/proc/self/fd/1", folder=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("<!DOCTYPE html>") and done.stdout.endswith("</html>\n")


def test_it_does_not_overwrite_what_it_reports_on(page, tmp_path):
    model, data, _ = page
    model.save(tmp_path / "model.json")
    data[:100].save(tmp_path / "data.csv")
    (tmp_path / "link.html").symlink_to("data.csv")
    before = (tmp_path / "data.csv").read_bytes()
    for output in ("model.json", "data.csv", "link.html"):
        done = run_module("model.json", "data.csv", "-o", output, folder=tmp_path)
        assert done.returncode == 1 and "would overwrite" in done.stderr
    assert (tmp_path / "data.csv").read_bytes() == before and mmbrdf.load(tmp_path / "model.json") == model


def test_importing_the_module_leaves_the_function():
    import mmbrdf.report

    assert callable(mmbrdf.report)


def test_a_browser_shows_it(page, tmp_path):
    browser = os.environ.get("MMBRDF_BROWSER") or shutil.which("chromium")
    if not browser:
        pytest.skip("no chromium: ./dev packages browser, or set MMBRDF_BROWSER")
    options = (
        "--headless --no-sandbox --disable-gpu --hide-scrollbars --no-first-run --disable-background-networking".split()
    )
    common = [
        browser,
        *options,
        "--disable-component-update",
        "--disable-sync",
        f"--user-data-dir={tmp_path / 'profile'}",
    ]
    dom = subprocess.run(
        [*common, "--virtual-time-budget=5000", "--dump-dom", page[2].as_uri()],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    ).stdout
    assert Outline(dom).headings[0] == "Report on sample & co"
    picture = tmp_path / "page.png"
    subprocess.run(
        [*common, "--window-size=1100,6000", f"--screenshot={picture}", page[2].as_uri()],
        capture_output=True,
        timeout=120,
        check=True,
    )
    import matplotlib.image

    pixels = matplotlib.image.imread(picture)[..., :3]
    colourful = (pixels.max(axis=-1) - pixels.min(axis=-1)) > 0.4  # the maps: a broken picture has none
    assert colourful.mean() > 0.005
