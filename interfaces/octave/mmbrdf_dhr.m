## SPDX-License-Identifier: BSD-3-Clause
## [dhr, u] = mmbrdf_dhr (model, wavelength_nm, theta_i_deg, phi_i_deg = 0): directional-hemispherical reflectance for
## unpolarized light, and its standard uncertainty.
function [dhr, u] = mmbrdf_dhr (model, wavelength_nm, theta_i_deg, phi_i_deg = 0)
  [dhr, u] = mmbrdf_oct ("dhr", model, wavelength_nm, mmbrdf_geometries (theta_i_deg, phi_i_deg));
endfunction
