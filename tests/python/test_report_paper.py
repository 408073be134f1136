# SPDX-License-Identifier: BSD-3-Clause
"""The report in a browser and on paper: nothing is clipped, cut or lies on something else. Skipped without a browser."""

import json
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml

import pytest

import mmbrdf

pytest.importorskip("matplotlib")

from mmbrdf import _browser, _pages, _report  # noqa: E402

pytestmark = pytest.mark.skipif(
    not _browser.browser(), reason="no chromium: ./dev packages browser, or set MMBRDF_BROWSER"
)

PAPERS = {"a4": (595.3, 841.9), "letter": (612.0, 792.0)}
"""Width and height in points."""

MARGIN = 40.0
"""Points around what is printed, but for the line with the page's number."""


@pytest.fixture(scope="module")
def reported():
    """Of several wavelengths and with samples that state uncertainties: all kinds of blocks, and long words of others."""
    model = mmbrdf.material("ptfe")
    data = mmbrdf.simulate(model, [351, 532, 633, 1064], mmbrdf.random_geometries(150, seed=1), speckle=0.01, seed=2)
    return model, data


@pytest.fixture(scope="module", autouse=True)
def drawn_once():
    """Pictures are the same on a screen and on each paper: what was drawn for one page is in the others, too."""
    draw, figure, known = _report._draw, _pages._figure, {}

    def kept(block, drawn):
        what = json.dumps(block, sort_keys=True)
        if what not in known:
            known[what] = figure(block, drawn())
        return known[what]

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(_report, "_draw", lambda source, block: lambda: draw(source, block))
        patched.setattr(_pages, "_figure", kept)
        yield


def source(reported):
    name = "a-very-long-name-of-a-file-" * 4 + ".json"
    return _report.Source(*reported, name=name, data_name="d.csv", command="mmbrdf report " + "word" * 60)


@pytest.fixture(scope="module")
def page(reported):
    return _report.made(source(reported), "html")


@pytest.fixture(scope="module", params=sorted(PAPERS))
def pdf(request, reported, tmp_path_factory):
    path = tmp_path_factory.mktemp("paper") / f"{request.param}.pdf"
    path.write_bytes(_report.made(source(reported), "pdf", _report.Look(paper=request.param)))
    return request.param, path


def pages_of(path):
    """Of each page its size, and its words with their boxes, in points from the top left."""
    if not shutil.which("pdftotext"):
        pytest.skip("no pdftotext: ./dev packages browser")
    text = subprocess.run(["pdftotext", "-bbox", str(path), "-"], capture_output=True, check=True).stdout.decode()
    text = re.sub(r"[\x00-\x08\x0b-\x1f]", "", re.sub(r"<!DOCTYPE[^>]*>", "", text)).replace("xmlns=", "ns=")
    box = lambda one: tuple(float(one.get(name)) for name in ("xMin", "yMin", "xMax", "yMax"))  # noqa: E731
    for page in xml.fromstring(text).iter("page"):
        size = float(page.get("width")), float(page.get("height"))
        yield size, [(word.text, box(word)) for word in page.iter("word")]


def test_pages_have_the_size_that_is_asked_for_and_nothing_lies_outside(pdf):
    paper, path = pdf
    count = 0
    for (width, height), words in pages_of(path):
        count += 1
        assert (width, height) == pytest.approx(PAPERS[paper], abs=1)
        for text, (left, top, right, bottom) in words:
            assert MARGIN < left and right < width - MARGIN, text
            assert MARGIN < top and bottom < height - 15, text
    assert 5 < count < 20


def test_no_words_lie_on_others(pdf):
    for _, words in pages_of(pdf[1]):
        for n, (text, (left, top, right, bottom)) in enumerate(words):
            for other, (left2, top2, right2, bottom2) in words[n + 1 :]:
                across, down = min(right, right2) - max(left, left2), min(bottom, bottom2) - max(top, top2)
                # Sub- and superscripts reach into the boxes of their lines; a third of a letter is no overlap.
                assert across < 1.5 or down < 0.6 * min(bottom - top, bottom2 - top2), (text, other)


def test_every_page_has_its_number_and_every_row_is_on_one_page(pdf):
    pages = list(pages_of(pdf[1]))
    for number, (_, words) in enumerate(pages, 1):
        assert [text for text, _ in words][-3:] == [str(number), "/", str(len(pages))]
    # The rows of this table begin with names that occur in the document only there.
    rows = [[text for text, _ in words] for _, words in pages]
    for symbol in ("DHR(0°)", "DHR(75°)", "BHR"):
        (where,) = [page for page in rows if symbol in page and "quantity" in page]
        assert len(re.findall(r"\d\(\d+\)", " ".join(where[where.index(symbol) : where.index(symbol) + 6]))) >= 4


MEASURE = """<script>
const found = [];
for (const one of document.querySelectorAll('body, body *')) {
  const style = getComputedStyle(one), box = one.getBoundingClientRect();
  if (one.scrollWidth > one.clientWidth + 1 && one.clientWidth > 0 && style.display !== 'inline')
    found.push('wider than its box: ' + one.tagName + ' ' + one.textContent.slice(0, 60));
  if (box.right > document.body.getBoundingClientRect().right + 1)
    found.push('beyond the page: ' + one.tagName + ' ' + one.textContent.slice(0, 60));
}
for (const one of document.images) if (!one.complete || one.naturalWidth === 0) found.push('no picture: ' + one.alt);
document.body.setAttribute('data-found', JSON.stringify(found));
</script></body>"""


def dumped(page, width_px, folder):
    """The page as a browser of this width makes it, with what MEASURE found."""
    (folder / "page.html").write_text(page.replace("</body>", MEASURE))
    command = [_browser.browser(), *_browser._OPTIONS, "--no-sandbox", f"--user-data-dir={folder}/profile"]
    command += [f"--window-size={width_px},2000", "--virtual-time-budget=20000", "--dump-dom"]
    done = subprocess.run([*command, (folder / "page.html").as_uri()], capture_output=True, timeout=240, check=True)
    (found,) = re.findall(r'data-found="([^"]*)"', done.stdout.decode())
    return json.loads(found.replace("&quot;", '"'))


@pytest.mark.parametrize("width_mm", [176, 182])
def test_on_paper_no_table_is_clipped_and_nothing_scrolls(page, tmp_path, width_mm):
    # As it is printed, in a window as wide as what is between the margins.
    page = page.replace("@media print", "@media all").replace("@media screen", "@media not all")
    page = page.replace("</style>", f"body {{ width: {width_mm}mm; margin: 0; }}</style>")
    assert dumped(page, 1000, tmp_path) == []


def test_on_a_screen_all_pictures_are_there_and_nothing_scrolls(page, tmp_path):
    assert dumped(page, 1200, tmp_path) == []


def test_the_page_of_samples_alone_is_printed_too(reported, tmp_path):
    mmbrdf.report(None, reported[1], tmp_path / "d.pdf", data_name="d.csv")
    for _, words in pages_of(tmp_path / "d.pdf"):
        assert all(MARGIN < box[0] and box[2] < PAPERS["a4"][0] - MARGIN for _, box in words)


def test_the_program_makes_the_pdf_and_at_the_same_date_the_same(tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1764460800")
    monkeypatch.setenv("MMBRDF_PYTHON", sys.executable)
    monkeypatch.setenv("PYTHONPATH", os.path.dirname(os.path.dirname(mmbrdf.__file__)))
    for name in ("one.pdf", "two.pdf"):
        command = [os.environ["MMBRDF_PROGRAM"], "report", "ptfe-532", "-o", "r.pdf"]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (0, "")
        (tmp_path / "r.pdf").rename(tmp_path / name)
    # Chromium now and then writes another byte somewhere; words and their places are the same.
    assert list(pages_of(tmp_path / "one.pdf")) == list(pages_of(tmp_path / "two.pdf"))
    words = " ".join(text for _, page in pages_of(tmp_path / "one.pdf") for text, _ in page)
    assert "2025-11-30T00:00:00+00:00" in words and "mmbrdf report ptfe-532 -o r.pdf" in words


def test_without_a_browser_one_line_says_what_to_do(reported, tmp_path, monkeypatch):
    monkeypatch.setenv("MMBRDF_BROWSER", str(tmp_path / "none"))
    with pytest.raises(ValueError, match=r"^PDF is printed by Chromium: .*none: No such file or directory$"):
        mmbrdf.report(mmbrdf.material("ptfe-532"), None, tmp_path / "r.pdf")
    monkeypatch.delenv("MMBRDF_BROWSER")
    monkeypatch.setattr(_browser, "_NAMES", ())
    drawn = []
    monkeypatch.setattr(_report, "_draw", lambda source, block: drawn.append(block))
    with pytest.raises(ValueError, match="^PDF is printed by Chromium, which was not found: install chromium, or name"):
        mmbrdf.report(mmbrdf.material("ptfe-532"), None, tmp_path / "r.pdf")
    assert not drawn, "it takes seconds, for nothing"
    monkeypatch.undo()
    monkeypatch.setenv("MMBRDF_BROWSER", "/bin/false")
    with pytest.raises(ValueError, match="^PDF is printed by Chromium: /bin/false made none: exit 1$"):
        mmbrdf.report(mmbrdf.material("ptfe-532"), None, tmp_path / "r.pdf")
    assert list(tmp_path.iterdir()) == []
