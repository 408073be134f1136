## SPDX-License-Identifier: BSD-3-Clause
## u = mmbrdf_evaluate_uncertainty (model, wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg, frame = "xy",
##                                  threads = 0)
## Standard uncertainties (k = 1) of what mmbrdf_evaluate gives; NaN where they are not known.
function u = mmbrdf_evaluate_uncertainty (model, wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg,
                                          frame = "xy", threads = 0)
  angles_deg = mmbrdf_angles (theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg);
  u = mmbrdf_oct ("uncertainty", model, wavelength_nm, angles_deg{:}, frame, "germer2017", threads);
endfunction
