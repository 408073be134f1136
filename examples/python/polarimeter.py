# SPDX-License-Identifier: BSD-3-Clause
"""A rotating-retarder polarimeter: from raw readings to a model whose uncertainty has the instrument in it.

A simulated goniometer stands in for the real one: with yours, start from its references.csv and raw.csv
(docs/formats.md).

    python3 examples/python/polarimeter.py
"""

import numpy as np

import mmbrdf

truth = mmbrdf.material("ptfe-532")
goniometer = mmbrdf.Goniometer(seed=1, speckle=0.01)
goniometer.write_references("references.csv", 532)
goniometer.write_raw("raw.csv", truth, 532, mmbrdf.random_geometries(1000, seed=1))

# The instrument: from readings of nothing, of a polarizer and of a coated wafer.
instrument = mmbrdf.calibrate("references.csv", film=goniometer.film)
print(instrument)
print(f"condition numbers {instrument.generator_condition:.2f}, {instrument.analyzer_condition:.2f}; best is 1.73")

# The samples: each with the uncertainty that noise of the readings gives it. Here that is speckle, not electronics.
data = mmbrdf.reduce("raw.csv", instrument, solid_angle=goniometer.solid_angle, noise={"relative": 0.01})
print(data)

# The model: what the instrument is uncertain by is the same in all samples, and more of them do not average it out.
model = mmbrdf.fit(data, weights="data", instrument=instrument, name="measured").model
question = (532, 45, 0, np.arange(-60, 61, 30), 180)
f, u = model.evaluate(*question), model.evaluate_uncertainty(*question)
for theta, value, its_u, true in zip(question[3], f[:, 0, 0], u[:, 0, 0], truth.evaluate(*question)[:, 0, 0]):
    print(f"theta_r {theta:4d}: f11 = {value:.4f} +- {its_u:.4f} sr^-1, in truth {true:.4f}")
