## SPDX-License-Identifier: BSD-3-Clause
## m = mmbrdf_evaluate (model, wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg, frame = "xy",
##                      convention = "germer2017", threads = 0)
## The Mueller BRDF in sr^-1: m(i, j, q) is row i (scattered), column j (incident light) at geometry q. Angles are numbers or
## arrays of one size, the wavelength is one number. Directions point away from the sample. What was not measured is NaN.
## frame is "xy", "sp" or "scattering_plane"; threads 0 is one for each core.
function m = mmbrdf_evaluate (model, wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg, frame = "xy",
                              convention = "germer2017", threads = 0)
  angles_deg = mmbrdf_angles (theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg);
  m = mmbrdf_oct ("evaluate", model, wavelength_nm, angles_deg{:}, frame, convention, threads);
endfunction
