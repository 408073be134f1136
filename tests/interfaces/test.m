## SPDX-License-Identifier: BSD-3-Clause
ptfe = mmbrdf_material ("ptfe");
show = @(name, numbers) printf ("%s%s\n", name, sprintf (" %.17g", numbers));
for q = 0:2
  g = {ptfe, 532, 20 + 30 * q, 10, 70 - 30 * q, 100};
  show ("matrix", mmbrdf_evaluate (g{:}, "sp", "p_first_right").');
  show ("uncertainty", mmbrdf_evaluate_uncertainty (g{:}, "sp").');
  s = mmbrdf_analyze (g{:}, "depolarization");
  show ("depolarization", [s.depolarization, s.u_depolarization]);
  [dhr, u] = mmbrdf_dhr (ptfe, 532, 20 + 30 * q, 10);
  show ("dhr", [dhr, u]);
  show ("outside", mmbrdf_outside (g{:}));
endfor
m = mmbrdf_evaluate (ptfe, 532, 20, 10, [70, 40, 10], 100);
assert (size (m), [4, 4, 3]);
assert (m(:, :, 2), mmbrdf_evaluate (ptfe, 532, 20, 10, 40, 100));
assert (numel (fieldnames (mmbrdf_analyze (ptfe, 532, 20, 10, 40, 100))) > 20);
function refused (action, message)
  try
    action ();
    said = "nothing";
  catch told
    said = told.message;
  end_try_catch
  assert (! isempty (strfind (said, message)), sprintf ("expected '%s', was told '%s'", message, said));
endfunction
refused (@() mmbrdf_material ("nowhere"), "'nowhere' is not one of ptfe");
refused (@() mmbrdf_load_model ("nowhere.json"), "nowhere.json");
refused (@() mmbrdf_evaluate (ptfe, 532, 95, 0, 30, 180), "geometry 1: theta_i = 95");
refused (@() mmbrdf_evaluate (ptfe, 532, [5 * ones(1, 70000), 95], 0, 30, 180), "geometry 70001: theta_i = 95");
refused (@() mmbrdf_evaluate (ptfe, 532, [1, 2], 0, [1, 2, 3], 180), "arrays of one size");
refused (@() mmbrdf_evaluate (ptfe, 532, 45, 0, 30, 180, "ps"), "ps");
for wrong = {[532, 633], "532", [], true, 532i, {532}}
  refused (@() mmbrdf_evaluate (ptfe, wrong{1}, 45, 0, 30, 180), "wavelength_nm must be one real number");
  refused (@() mmbrdf_evaluate_uncertainty (ptfe, wrong{1}, 45, 0, 30, 180), "wavelength_nm must be one real number");
  refused (@() mmbrdf_analyze (ptfe, wrong{1}, 45, 0, 30, 180), "wavelength_nm must be one real number");
  refused (@() mmbrdf_outside (ptfe, wrong{1}, 45, 0, 30, 180), "wavelength_nm must be one real number");
  refused (@() mmbrdf_dhr (ptfe, wrong{1}, 45), "wavelength_nm must be one real number");
endfor
assert (mmbrdf_evaluate (ptfe, int32 (532), 45, 0, 30, 180), mmbrdf_evaluate (ptfe, 532, 45, 0, 30, 180));
for wrong = {-1, 1.5, NaN, Inf, [], [1, 2], "2"}
  refused (@() mmbrdf_evaluate (ptfe, 532, 45, 0, 30, 180, "xy", "germer2017", wrong{1}), "threads");
  refused (@() mmbrdf_evaluate_uncertainty (ptfe, 532, 45, 0, 30, 180, "xy", wrong{1}), "threads");
  refused (@() mmbrdf_analyze (ptfe, 532, 45, 0, 30, 180, "f_ss", wrong{1}), "threads");
endfor
refused (@() mmbrdf_evaluate (5, 532, 45, 0, 30, 180), "model must be one of");
