## SPDX-License-Identifier: BSD-3-Clause
## model = mmbrdf_material (name): a built-in model, such as "ptfe".
function model = mmbrdf_material (name)
  model = mmbrdf_oct ("material", name);
endfunction
