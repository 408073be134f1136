# SPDX-License-Identifier: BSD-3-Clause
"""What a type checker says of programs that use the package."""

import subprocess
import sys

import pytest

pytest.importorskip("mypy", reason="no mypy: ./dev packages python")

PROGRAM = """\
import mmbrdf
import mmbrdf.plot

model: mmbrdf.Model = mmbrdf.material("ptfe")
data: mmbrdf.Dataset = mmbrdf.simulate(model, 532, mmbrdf.germer2017_grid())
figure, axes = mmbrdf.plot.in_plane_curves(model, 532, theta_i_deg=60, phi_i_deg=0)
figure.savefig("curves.png")
mmbrdf.plot.hemisphere(model, 532, 60)
mmbrdf.plot.residual_map(model, data, None, 60)
mmbrdf.plot.polar_in_plane([model], [532, 633])
mmbrdf.report(model, data, "report.html", theta_i_deg=60)
"""


def checked(text, folder):
    """Status and messages of mypy --strict."""
    (folder / "program.py").write_text(text)
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir=/dev/null", "program.py"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def test_programs_with_plots_and_reports_pass(tmp_path):
    assert checked(PROGRAM, tmp_path) == (0, "Success: no issues found in 1 source file\n")


@pytest.mark.parametrize(
    "wrong, message",
    [
        ('mmbrdf.report(data, data, "report.html")', 'incompatible type "Dataset"; expected "Model"'),
        ("mmbrdf.plot.in_plane_curves(mmbrdf.fit(data), 532)", 'incompatible type "FitResult"; expected "Model"'),
        ('mmbrdf.plot.hemisphere(model, "532", 60)', 'incompatible type "str"'),
    ],
)
def test_wrong_ones_are_found(tmp_path, wrong, message):
    status, printed = checked(PROGRAM + wrong + "\n", tmp_path)
    assert status == 1 and message in printed and "Found 1 error" in printed
