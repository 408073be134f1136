## SPDX-License-Identifier: BSD-3-Clause
## flags = mmbrdf_outside (model, wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg)
## 0 within the range to which the model was fitted, or a sum of 1 (theta_i), 2 (theta_r), 4 (wavelength), 8 (not known),
## 16 (no samples near these directions) and 32 (not outside: between two fitted wavelengths).
function flags = mmbrdf_outside (model, wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg)
  flags = mmbrdf_oct ("outside", model, wavelength_nm,
                      mmbrdf_geometries (theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg));
endfunction
