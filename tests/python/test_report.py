# SPDX-License-Identifier: BSD-3-Clause
"""The report page: complete, self-contained, and shown by a browser."""

import hashlib
import html.parser
import json
import os
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest

import mmbrdf

pytest.importorskip("matplotlib")

from mmbrdf import _pages, _report, _table_options  # noqa: E402


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """A report on a fit to simulated data, as text and file."""
    folder = tmp_path_factory.mktemp("report")
    data = mmbrdf.simulate(mmbrdf.material("ptfe"), 532, mmbrdf.germer2017_grid(), speckle=0.01, seed=1)
    model = mmbrdf.fit(data, name="sample & co").model
    mmbrdf.report(model, data, folder / "report.html", data_name="<simulated>")
    return model, data, folder / "report.html"


@pytest.fixture
def blank(monkeypatch):
    """Every picture is an empty figure: for tests of the words, which half a minute of drawing would not make better."""
    from matplotlib.figure import Figure

    monkeypatch.setattr(_report, "_draw", lambda source, block: Figure(figsize=(1, 1)))


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


def shown(text):
    """Its text, without pictures and style; subscripts as letters of the line."""
    plain = re.sub(r'src="data:[^"]*"|<style>.*?</style>', "", text, flags=re.DOTALL)
    plain = plain.replace("<sub>i</sub>", "ᵢ").replace("<sub>r</sub>", "ᵣ")
    return html.unescape(re.sub("<[^>]*>", "\n", plain)).replace("\u00a0", " ")


def in_words(text):
    """Of Markdown or a page, what is neither blank nor markup: the same content has the same."""
    return re.sub(r"[\s|*#\\-]", "", text)


@pytest.mark.usefixtures("blank")
def test_the_page_the_markdown_and_the_program_say_the_same(page, tmp_path, program):
    model, data, _ = page
    model.save(tmp_path / "m.json")
    data.save(tmp_path / "d.csv")
    files = dict(model_file=tmp_path / "m.json", data_file=tmp_path / "d.csv", name="m.json", data_name="d.csv")
    read = mmbrdf.load(tmp_path / "m.json"), mmbrdf.load(tmp_path / "d.csv")
    mmbrdf.report(*read, tmp_path / "r.md", **files)
    mmbrdf.report(*read, tmp_path / "r.html", **files)
    markdown, text = (tmp_path / "r.md").read_text(), shown((tmp_path / "r.html").read_text())
    printed = program("report", "m.json", "d.csv")
    own = lambda words: [  # noqa: E731: without the date and the command
        line for line in words.splitlines() if not line.startswith(("| date", "| command | mmbrdf"))
    ]
    assert own(printed) == own(markdown)
    cells = [cell.strip() for line in markdown.splitlines() if line.startswith("|") for cell in line.split("|")[1:-1]]
    whole = in_words(text)
    for cell in cells:
        if not re.fullmatch(r":?-+:?", cell) and not re.match(r"\d{4}-\d\d-\d\dT", cell):
            assert in_words(cell) in whole, cell
    for heading in re.findall("^## (.*)$", markdown, re.MULTILINE):
        if heading != "Contents":
            assert in_words(heading) in whole, heading


def test_the_facts_are_those_of_the_program(ptfe, program, tmp_path):
    asked = [532, 600]  # fitted, and between
    printed = json.loads(program("report", "ptfe", "-w", "532,600", "--format", "json"))
    origin = printed.pop("origin")
    assert printed == json.loads(mmbrdf.report_json(ptfe, "ptfe", asked))
    mmbrdf.report(ptfe, None, tmp_path / "r.json", name="ptfe", wavelength_nm=asked, model_file="ptfe")
    ours = json.loads((tmp_path / "r.json").read_text())
    assert (
        ours.pop("origin")["files"] == origin["files"] == [{"what": "model", "name": "ptfe (built in)", "sha256": None}]
    )
    assert ours == printed


@pytest.mark.usefixtures("blank")
def test_terms_are_in_all_u_as_by_the_program(ptfe, program, tmp_path):
    typed = ["plaque:scale=0.3%,dof=12", "theta_r=0.02deg"]
    words = [word for term in typed for word in ("--term", term)]
    printed = json.loads(program("report", "ptfe", "-w", 532, *words, "--format", "json"))
    del printed["origin"]
    assert printed == json.loads(mmbrdf.report_json(ptfe, "ptfe", [532], terms=typed))
    named = json.loads(mmbrdf.report_json(ptfe, "ptfe", [532], terms={"scale": 0.003, "theta_r_deg": 0.02}))
    assert [row["u"] for row in named["reflectances"]] == pytest.approx([row["u"] for row in printed["reflectances"]])
    mmbrdf.report(ptfe, None, tmp_path / "r.html", wavelength_nm=532, terms=typed)
    text = shown((tmp_path / "r.html").read_text())
    assert "of the sample with declared errors and of the terms plaque, θᵣ" in text
    with pytest.raises(ValueError, match="^terms: 'scale': expected \\[NAME:\\]KIND=VALUE"):
        mmbrdf.report(ptfe, None, tmp_path / "r.md", terms=["scale"])
    with pytest.raises(ValueError, match="^terms: they are of the u of a model, and there is none$"):
        mmbrdf.report(None, mmbrdf.simulate(ptfe, 532, mmbrdf.in_plane(0, [20])), tmp_path / "r.html", terms=typed)


def test_it_begins_with_the_sample_its_reflectances_and_chi_squared(page):
    text = shown(page[2].read_text())
    first = text[text.index("sample & co at 532 nm") :].replace("\n", "")
    assert re.match(
        r"sample & co at 532 nm: directional-hemispherical reflectance DHR\(8°\) = 0\.\d+\(\d\d\); "
        r"reflectance factor R\(0°:45°\) = [01]\.\d+\(\d\d\); χ²/ν is not known, for the samples do not state their "
        r"uncertainties\. Uncertainties are standard \(k = 1\), of the sample",
        first,
    )


def test_uncertainties_are_written_as_it_is_asked(ptfe, tmp_path):
    for notation, number in (("brackets", r"0\.98\d\d\(\d\d\)"), ("plus-minus", r"0\.98\d\d ± 0\.00\d\d")):
        mmbrdf.report(ptfe, None, tmp_path / "r.md", wavelength_nm=532, notation=notation)
        first = (tmp_path / "r.md").read_text().split("\n")[2]
        assert re.search(rf"DHR\(8°\) = {number}; R?", first), first


@pytest.mark.usefixtures("blank")
def test_it_says_of_what_it_was_made(page, tmp_path, monkeypatch):
    model, data, _ = page
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1764460800")
    data.save(tmp_path / "d.csv")
    digest = hashlib.sha256((tmp_path / "d.csv").read_bytes()).hexdigest()
    for given in ({}, {"data_file": tmp_path / "d.csv"}):
        mmbrdf.report(model, data, tmp_path / "r.html", data_name="d.csv", **given)
        text = shown((tmp_path / "r.html").read_text())
        for words in ("2025-11-30T00:00:00+00:00", f"mmbrdf {mmbrdf.__version__}", digest, "d.csv"):
            assert words in text
    first = (tmp_path / "r.html").read_bytes()
    mmbrdf.report(model, data, tmp_path / "r.html", data_name="d.csv", **given)
    assert (tmp_path / "r.html").read_bytes() == first


def test_the_same_picture_has_the_same_bytes(page):
    model, data, _ = page
    drawn = [_pages.image(mmbrdf.plot.residuals(model, data)[0], "residuals", "svg") for _ in range(2)]
    one, other = (hashlib.sha256(text.encode()).hexdigest() for text in drawn)  # of the texts a failure would print all
    assert one == other


def test_another_ending_is_refused_in_a_line_and_nothing_is_written(ptfe, tmp_path):
    for name in ("r.txt", "r", "r.htmlx"):
        with pytest.raises(ValueError, match=r": expected a file that ends with \.md, \.html, \.pdf or \.json$"):
            mmbrdf.report(ptfe, None, tmp_path / name)
        done = run_module("ptfe-532", "-o", name, folder=tmp_path)
        assert done.returncode == 2 and done.stderr.count("\n") == 2 and "or --format" in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_symbols_are_as_in_print_but_for_words_of_others(page):
    text = shown(page[2].read_text())
    assert "θᵢ ≤" in text and "sr⁻¹" in text and "χ²" in text
    assert not re.search(r"theta_[ir](?!_deg)|sr\^-1|chi\^2|phi_[ir](?!_deg)|_coefficients", text)


@pytest.mark.usefixtures("blank")
def test_several_wavelengths_have_one_picture_and_not_a_page_each(ptfe, tmp_path):
    mmbrdf.report(ptfe, None, tmp_path / "r.html")
    text = (tmp_path / "r.html").read_text()
    assert text.count('src="data:image') == 7  # two of reflectances, small multiples, hemisphere, limits, two powers
    assert shown(text).count("The model from wavelength to wavelength") >= 1


@pytest.mark.usefixtures("blank")
def test_residuals_of_random_directions_are_shown(ptfe, tmp_path):
    data = mmbrdf.simulate(ptfe, 532, mmbrdf.random_geometries(400, seed=1), speckle=0.01, seed=2)
    mmbrdf.report(ptfe, data, tmp_path / "r.html", wavelength_nm=532)
    assert "Residuals of all samples" in shown((tmp_path / "r.html").read_text())


def test_the_page_needs_nothing_else(page):
    outline = Outline(page[2].read_text())
    # two of reflectances, hemisphere, curves, limits, residuals of all, three maps of them, coefficients
    assert len(outline.pictures) == 10
    assert all(link.startswith("#") for link in outline.links)
    assert not re.search(r"https?://(?!www\.w3\.org)", re.sub(r'src="data:[^"]*"', "", page[2].read_text()))


def test_names_are_text_and_not_markup(page):
    text = page[2].read_text()
    assert "sample &amp; co" in text and "&lt;simulated&gt;" in text and "<simulated>" not in text


@pytest.mark.usefixtures("blank")
def test_warnings_come_first(tmp_path):
    model = mmbrdf.in_published_form(mmbrdf.material("ptfe-532"))
    mmbrdf.report(model, None, tmp_path / "report.html", wavelength_nm=532)
    text = re.sub(r"<style>.*?</style>", "", (tmp_path / "report.html").read_text(), flags=re.DOTALL)
    assert (
        text.index('class="list warnings"') < text.index("<h2")
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
        ((fitted, data), "report: model: expected mmbrdf.Model, not FitResult: its .model is one"),
        ((data, model), "report: model: expected mmbrdf.Model, not Dataset"),
        ((model, fitted), "report: data: expected mmbrdf.Dataset, not FitResult"),
        ((model, tmp_path), f"report: data: expected mmbrdf.Dataset, not {type(tmp_path).__name__}"),
    ):
        with pytest.raises(TypeError, match=f"^{re.escape(message)}$"):
            mmbrdf.report(*arguments, tmp_path / "report.html")
    for option, message in (
        ({"wavelength_nm": "532 nm"}, "wavelength_nm: expected a number, not '532 nm'"),
        ({"theta_i_deg": None}, "report: theta_i_deg: expected a number, not NoneType"),
    ):
        with pytest.raises(TypeError, match=f"^{re.escape(message)}$"):
            mmbrdf.report(model, data, tmp_path / "report.html", **option)
    assert list(tmp_path.iterdir()) == []


def headings(path):
    return Outline(path.read_text()).headings


@pytest.mark.usefixtures("blank")
def test_published_coefficients_are_reported_on_at_the_wavelengths_of_the_samples(ptfe, tmp_path):
    mmbrdf.in_published_form(ptfe).save(tmp_path / "published.csv")
    model = mmbrdf.load(tmp_path / "published.csv")
    data = mmbrdf.simulate(ptfe, 633, mmbrdf.germer2017_grid(), speckle=0.01, seed=2)
    mmbrdf.report(model, data, tmp_path / "report.html")
    assert "published at 633 nm" in shown((tmp_path / "report.html").read_text())
    with pytest.raises(ValueError, match="published does not say to which wavelengths it was fitted"):
        mmbrdf.report(model, None, tmp_path / "report.html")


@pytest.mark.usefixtures("blank")
def test_a_model_of_one_unknown_wavelength_is_not_said_to_have_one(tmp_path):
    mmbrdf.in_published_form(mmbrdf.material("ptfe-532")).save(tmp_path / "published.csv")
    mmbrdf.report(mmbrdf.load(tmp_path / "published.csv"), None, tmp_path / "report.html")
    assert "The model in pictures" in headings(tmp_path / "report.html")
    assert not re.search(r"\d nm", shown((tmp_path / "report.html").read_text()))


def azimuths(path):
    captions = "".join(re.findall("<figcaption.*?</figcaption>", path.read_text()))
    return re.findall(r"φᵢ = (\S+)°", shown(captions))


@pytest.mark.usefixtures("blank")
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


def drawn_at(model, azimuth, tmp_path, monkeypatch):
    """What is drawn of the model for samples from this azimuth, by kind of picture; the others are empty figures."""
    from matplotlib.figure import Figure

    draw, found = _report._draw, {}

    def kept(source, block):
        if block["plot"] not in ("hemisphere", "in-plane-curves", "realizability-map"):
            return Figure(figsize=(1, 1))
        figure = draw(source, block)
        found[block["plot"]] = _pages.image(figure, "", "svg")
        return Figure(figsize=(1, 1))

    grid = mmbrdf.germer2017_grid()
    turned = grid._replace(phi_i_deg=np.full(len(grid.theta_i_deg), azimuth))
    with monkeypatch.context() as patched:
        patched.setattr(_report, "_draw", kept)
        mmbrdf.report(model, mmbrdf.simulate(model, 532, turned), tmp_path / "report.html")
    return found


def test_the_pictures_are_drawn_at_the_azimuth_that_their_captions_name(anisotropic, tmp_path, monkeypatch):
    one, other = (drawn_at(anisotropic, azimuth, tmp_path, monkeypatch) for azimuth in (30.0, 180.0))
    assert len(one) == len(other) == 3
    assert all(one[kind] != other[kind] for kind in one)


def test_without_samples_the_message_says_where(page, tmp_path):
    model, data, _ = page
    with pytest.raises(ValueError, match=r"^empty\.csv: no samples$"):
        mmbrdf.report(model, data[:0], tmp_path / "report.html", data_name="empty.csv")
    data[:1].save(tmp_path / "empty.csv")
    (tmp_path / "empty.csv").write_text((tmp_path / "empty.csv").read_text().splitlines()[0] + "\n")
    done = run_module("ptfe-532", "empty.csv", "-o", "report.html", folder=tmp_path)
    assert done.returncode == 1 and "empty.csv" in done.stderr and done.stderr.count("\n") == 1


def test_a_missing_folder_is_named_as_it_was_given_before_anything_is_drawn(page, tmp_path, monkeypatch):
    monkeypatch.setattr(_report, "_draw", lambda source, block: pytest.fail("drawn for nothing"))
    with pytest.raises(FileNotFoundError) as error:
        mmbrdf.report(page[0], None, tmp_path / "no" / "report.html")
    assert error.value.filename == str(tmp_path / "no" / "report.html")


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


def test_the_commands_of_its_pictures_read_the_table_as_it_did(page, tmp_path, program):
    page[1].save(tmp_path / "d.csv")
    (tmp_path / "d.csv").write_text((tmp_path / "d.csv").read_text().replace("theta_i_deg", "AOI [x]"))
    how = ["--columns", "theta_i_deg=AOI [x]", "--frame", "xy", "--skip-incomplete"]
    done = run_module("ptfe", "d.csv", *how, "-o", "report.md", folder=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    command = "mmbrdf plot residuals ptfe d.csv --columns 'theta_i_deg=AOI [x]' --skip-incomplete --frame xy -w"
    for text in ((tmp_path / "report.md").read_text(), program("report", "ptfe", "d.csv", *how)):
        assert command in text


@pytest.mark.usefixtures("blank")
@pytest.mark.parametrize("name", ["$_{$.csv", "纸样.csv", "<i>&amp;.csv"])
def test_file_names_are_text_whatever_is_in_them(name, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    mmbrdf.in_published_form(mmbrdf.material("ptfe-532")).save(tmp_path / name)
    assert _report.main([name, "-o", "report.html"]) == 0 and capsys.readouterr().err == ""
    assert headings(tmp_path / "report.html")[0] == f"Report on {name}"


@pytest.mark.usefixtures("blank")
def test_it_prints_the_page_where_that_is_asked_for(capfd):
    assert _report.main(["ptfe-532", "--format", "html", "-o", "/proc/self/fd/1"]) == 0
    out, error = capfd.readouterr()
    assert error == "" and out.startswith("<!DOCTYPE html>") and out.endswith("</html>\n")


def test_it_does_not_overwrite_what_it_reports_on(page, tmp_path):
    model, data, _ = page
    model.save(tmp_path / "model.json")
    data[:100].save(tmp_path / "data.csv")
    (tmp_path / "link.html").symlink_to("data.csv")
    before = (tmp_path / "data.csv").read_bytes()
    for output in ("model.json", "data.csv", "link.html"):
        done = run_module("model.json", "data.csv", "--format", "html", "-o", output, folder=tmp_path)
        assert done.returncode == 1 and "would overwrite" in done.stderr
    assert (tmp_path / "data.csv").read_bytes() == before and mmbrdf.load(tmp_path / "model.json") == model


@pytest.mark.parametrize("ending", ["md", "html"])
def test_a_file_that_is_replaced_while_it_is_read_has_no_report(page, tmp_path, monkeypatch, capsys, ending):
    """Its digest would be that of another one."""
    model, data, _ = page
    model.save(tmp_path / "model.json")
    data.save(tmp_path / "data.csv")
    data[:100].save(tmp_path / "other.csv")
    read = _table_options.read_samples

    def replaced_after(path, **options):
        result = read(path, **options)
        os.replace(tmp_path / "other.csv", tmp_path / "data.csv")
        return result

    monkeypatch.setattr(_table_options, "read_samples", replaced_after)
    arguments = [str(tmp_path / name) for name in ("model.json", "data.csv")]
    output = ["-o", str(tmp_path / f"r.{ending}")]
    assert _report.main([*arguments[ending == "html" :], *output]) == 1
    assert capsys.readouterr().err.endswith("data.csv: changed while it was read: run it again\n")
    assert not (tmp_path / f"r.{ending}").exists()


def test_the_digest_is_that_of_what_was_read(page, tmp_path, monkeypatch):
    """And not that of the file that took its place before the pictures were drawn."""
    model, data, _ = page
    model.save(tmp_path / "model.json")
    digest = hashlib.sha256((tmp_path / "model.json").read_bytes()).hexdigest()

    def facts(*given):
        (tmp_path / "model.json").write_text("{}")
        return mmbrdf.report_json(*given)

    monkeypatch.setattr(_report, "report_json", facts)
    assert _report.main([str(tmp_path / "model.json"), "-o", str(tmp_path / "r.md")]) == 0
    assert digest in (tmp_path / "r.md").read_text()


def test_importing_the_module_leaves_the_function():
    import mmbrdf.report

    assert callable(mmbrdf.report)
