# SPDX-License-Identifier: BSD-3-Clause
"""The tutorials run as they stand, and say what they should."""

import os
import re
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "examples/python"


@pytest.fixture
def printed(printed_by):
    return lambda name, *arguments: printed_by(sys.executable, "-W", "error::UserWarning", FOLDER / name, *arguments)


def numbers(pattern, text):
    """What the groups of a pattern are in each line that has it."""
    return [tuple(map(float, match.groups())) for match in re.finditer(pattern, text)]


def test_every_tutorial_is_tested():
    assert {path.stem for path in FOLDER.glob("*.py")} == {
        "quick_start",
        "plaque_correction",
        "fit_your_data",
        "polarimeter",
        "real_samples",
    }


def test_quick_start(printed):
    text = printed("quick_start.py")
    assert numbers(r"f11 = ([\d.]+) \+- ([\d.]+) sr", text) == [(0.3282, 0.0012)]  # as in the README
    assert "array of (3, 7, 4, 4)" in text


def test_plaque_correction_falls_with_the_sun(printed):
    rows = numbers(r"(\d+) deg +([\d.]+) +([\d.]+) +0\.3000 +([\d.]+) \+- ([\d.]+)", printed("plaque_correction.py"))
    assert [row[0] for row in rows] == [10, 20, 30, 40, 50, 60, 70]
    factors = [row[1] for row in rows]
    assert factors == sorted(factors, reverse=True) and factors[0] > 1.02 and factors[-1] < 0.95
    for _, factor, u, target, u_target in rows:
        assert 0.005 * factor <= u + 1e-4 and u < 0.01 * factor  # 0.5 % of scale, and a little of the fit
        assert target == pytest.approx(0.3 * factor, abs=1e-4) and u_target == pytest.approx(0.3 * u, abs=1e-4)


def test_fit_your_data(printed, samples, tmp_path):
    samples.save(tmp_path / "data.csv")
    text = printed("fit_your_data.py", "data.csv")
    assert text.replace("data.csv", "") == printed("fit_your_data.py")  # its own example is the same measurement
    left_out = [rms for _, _, rms in numbers(r"orders \((\d), (\d)\): rms of what was left out ([\d.]+)", text)]
    assert left_out[1] < left_out[0] and left_out[1] < left_out[2]  # the orders it was made with predict best
    assert "saved: <mmbrdf.Model 'my sample'" in text


def test_polarimeter(printed):
    rows = numbers(r"f11 = ([\d.]+) \+- ([\d.]+) sr\^-1, in truth ([\d.]+)", printed("polarimeter.py"))
    assert len(rows) == 5
    for value, u, truth in rows:
        assert abs(value - truth) < 4 * u and u < 0.01 * value


def test_real_samples(printed, tmp_path):
    folder = Path(os.environ.get("MMBRDF_DATA", FOLDER.parents[2] / "shared/data/germer2017"))
    if not (folder / "PTFE.data.random.csv").exists():
        pytest.skip("the published data are not present")
    text = printed("real_samples.py", str(folder), str(tmp_path / "picture.png"))
    assert (tmp_path / "picture.png").stat().st_size > 50_000
    noise, sample = ([float(x) for x in re.findall(r"(\d+) %", line)] for line in text.splitlines())
    assert max(noise) < 75 and min(sample) >= 95
