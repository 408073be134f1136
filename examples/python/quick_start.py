# SPDX-License-Identifier: BSD-3-Clause
"""Quick start: a white reference material as a Mueller-matrix BRDF.

    python3 examples/python/quick_start.py
"""

import numpy as np

import mmbrdf

ptfe = mmbrdf.material("ptfe")
print(ptfe)

# One geometry: light from 45 degrees, seen at 30 degrees on the other side (forward scattering is 180 degrees).
f = ptfe.evaluate(wavelength_nm=532, theta_i_deg=45, phi_i_deg=0, theta_r_deg=30, phi_r_deg=180, frame="sp")
u = ptfe.evaluate_uncertainty(wavelength_nm=532, theta_i_deg=45, phi_i_deg=0, theta_r_deg=30, phi_r_deg=180, frame="sp")
print(f"f11 = {f[0, 0]:.4f} +- {u[0, 0]:.4f} sr^-1")

# Many: all arguments broadcast as numpy arrays do. Wavelengths down, detector angles across.
theta_r = np.arange(-60, 61, 20)
matrices = ptfe.evaluate(
    wavelength_nm=np.array([[351], [532], [1064]]), theta_i_deg=45, phi_i_deg=0, theta_r_deg=theta_r, phi_r_deg=180
)
print(f"array of {matrices.shape}: wavelength, theta_r, row, column")
print("depolarization (0: complete, 1: none) against theta_r:")
for wavelength, row in zip((351, 532, 1064), mmbrdf.depolarization(matrices)):
    print(f"  {wavelength:4d} nm  " + "  ".join(f"{value:.4f}" for value in row))

# Reflectances over the hemisphere are closed forms.
dhr = mmbrdf.directional_hemispherical_reflectance(ptfe, 532, theta_i_deg=8)
u_dhr = mmbrdf.directional_hemispherical_uncertainty(ptfe, 532, theta_i_deg=8)
print(f"8 degrees : hemisphere reflectance = {dhr:.4f} +- {u_dhr:.4f}")
