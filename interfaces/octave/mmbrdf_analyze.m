## SPDX-License-Identifier: BSD-3-Clause
## s = mmbrdf_analyze (model, wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg, names = all, threads = 0)
## Derived quantities, each a row of s, with their standard uncertainties: s.depolarization, s.u_depolarization. NaN where a
## quantity has no meaning, or an uncertainty is not known.
function s = mmbrdf_analyze (model, wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg,
                             names = mmbrdf_oct ("quantities"), threads = 0)
  names = cellstr (names);
  [values, u] = mmbrdf_oct ("analyze", model, wavelength_nm,
                            mmbrdf_geometries (theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg), names, threads);
  for k = 1:numel (names)
    s.(names{k}) = values(:, k)';
    s.(["u_", names{k}]) = u(:, k)';
  endfor
endfunction
