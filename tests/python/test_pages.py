# SPDX-License-Identifier: BSD-3-Clause
"""What README.md and docs/python.md show of Python runs as it stands; pictures of the latter are in test_plot_kinds.py, questions
with u and validity in test_asking.py, readings in test_readings.py."""

import re
import shutil
from pathlib import Path

import pytest

import mmbrdf

SOURCE = Path(__file__).parents[2]


def blocks(page):
    text = (SOURCE / page).read_text(encoding="utf-8").split("\n## Pictures\n")
    without_pictures = text[0] + text[1][text[1].index("\n**") :] if len(text) > 1 else text[0]
    found = re.findall(r"^```python\n(.*?)^```$", without_pictures, re.MULTILINE | re.DOTALL)
    return [block for block in found if 'invalid="nan"' not in block and "mmbrdf.calibrate(readings" not in block]


@pytest.mark.parametrize("page, count", [("README.md", 1), ("docs/python.md", 5)])
def test_the_code_of_a_page_runs(page, count, samples, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    samples.save("data.csv")
    others = mmbrdf.simulate(mmbrdf.material("ptfe"), 532, mmbrdf.random_geometries(400, seed=2), speckle=0.01, seed=2)
    missing = samples.mueller.copy()
    missing[16] = -999
    model = mmbrdf.material("ptfe-532")
    model.save("sample.json")
    names = {"mmbrdf": mmbrdf, "others": others, "model": model}
    found = blocks(page)
    assert len(found) == count
    for block in found:
        if ".pdf" in block and not shutil.which("chromium"):
            continue  # which prints it; test_report_paper.py says so of what it skips
        has_faults = "mmbrdf.inspect(" in block  # it shows a fill value
        data = mmbrdf.Dataset(532, *samples.geometry, missing) if has_faults else samples
        exec(block, names | {"data": data} if "mmbrdf.load(" not in block else names)
