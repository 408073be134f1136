# SPDX-License-Identifier: BSD-3-Clause
"""What a type checker says of programs that use the package."""

import os
import re
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
mmbrdf.plot.map(data, "22", 532, 60, minus=model, show="value / u", width_cm=8)
mmbrdf.plot.map(model, mmbrdf.depolarization, 532, 60, limits=(0, 0.2))
mmbrdf.plot.in_plane_curves(model, 532, data=data, width_cm=8)
mmbrdf.plot.reflectance_factor(model, [443, 670], views=[(0, 0), (45, 180)], terms={"scale": 0.003})
mmbrdf.plot.uncertainty_parts(model, 532, quantity="dhr")
mmbrdf.report(model, data, "report.html", theta_i_deg=60)
seen: mmbrdf.Inspection = mmbrdf.inspect(data)
mmbrdf.plot.directions(data, 532, inspection=seen)
mmbrdf.report(None, data[list(seen.findings[0].samples)], "page.html")
f11 = model.evaluate(532, 45, 0, [0, 30], 180)[..., 0, 0] + 1
names = model.evaluate(532, 45, 0, [0, 30], 180, as_xarray=True).dims
whole: mmbrdf.Evaluation = model.evaluate(532, 45, 0, [0, 30], 180, uncertainty=True, terms={"scale": 0.003}, invalid="nan")
both = model.evaluate(532, 45, 0, [0, 30], 180, uncertainty=True, as_xarray=True).data_vars
factor: mmbrdf.Evaluation = model.reflectance_factor(theta_i_deg=0, phi_i_deg=0, theta_r_deg=45, phi_r_deg=0, uncertainty=True)
dhr: mmbrdf.Evaluation = mmbrdf.directional_hemispherical_reflectance(model, 532, [8, 45], uncertainty=True)
curves: mmbrdf.PolarizedBrdf = mmbrdf.polarized_curve(model, 532, mmbrdf.in_plane(45, [0, 30]), invalid="nan")
text: str = model.summary() + data.summary()
instrument = mmbrdf.calibrate({"number": [1, 2], "intensity": [0.1, 0.2]}, columns={"wavelength_nm": "nm"})
worst: float = max(one.figure_of_merit for one in instrument.references)
u = model.evaluate_uncertainty(theta_i_deg=45, phi_i_deg=0, theta_r_deg=0, phi_r_deg=0)
values = [part.f11 for part in data[:3]]
fitted: mmbrdf.Model = mmbrdf.fit(data, weights="speckle", reflectance={532: 0.98}).model
choice: mmbrdf.Selection = mmbrdf.select(data, orders_f11=(2, 7))
error: float | None = choice.f11[0].cross_validation["angle"].rms
spread: float = mmbrdf.subsets(data, reference=model).splits[0].curves[0].ss.mean()
where: mmbrdf.Geometry = mmbrdf.model_diagnostics(model).margin_at
most: float = mmbrdf.compare(model, fitted).normalized["22"].largest
names_of_outliers = [one.element for one in mmbrdf.outliers(mmbrdf.sample_diagnostics(mmbrdf.fit(data), data))]
"""


WRONG = {
    'mmbrdf.report(data, data, "report.html")': 'incompatible type "Dataset"; expected',
    "mmbrdf.plot.in_plane_curves(mmbrdf.fit(data), 532)": 'incompatible type "FitResult"; expected "Model"',
    "mmbrdf.plot.map(model, 11, 532)": 'incompatible type "int"',
    'mmbrdf.plot.hemisphere(model, "532", 60)': 'incompatible type "str"',
    "model.evaluate(532)": 'No overload variant of "evaluate"',
    'model.evaluate(532, 45, 0, 0, 0, invalid="skip")': 'No overload variant of "evaluate"',
    "model.save(1)": 'incompatible type "int"',
}


# xarray is not followed into dask, which takes as long as all the rest.
CONFIGURATION = """\
[mypy]
strict = True
[mypy-dask.*,distributed.*]
follow_imports = skip
"""


def test_what_is_wrong_is_found_where_it_is_and_nothing_in_what_is_right(tmp_path):
    (tmp_path / "mypy.ini").write_text(CONFIGURATION)
    (tmp_path / "program.py").write_text(PROGRAM + "\n".join(WRONG) + "\n")
    command = [sys.executable, "-m", "mypy", f"--cache-dir={os.devnull}", "program.py"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and f"Found {len(WRONG)} errors in 1 file" in done.stdout, done.stdout + done.stderr
    for line, message in enumerate(WRONG.values(), PROGRAM.count("\n") + 1):
        assert re.search(f"^program.py:{line}: error: .*{re.escape(message)}", done.stdout, re.MULTILINE), done.stdout
