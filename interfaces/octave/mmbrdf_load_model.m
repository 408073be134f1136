## SPDX-License-Identifier: BSD-3-Clause
## model = mmbrdf_load_model (path): a model from a file.
function model = mmbrdf_load_model (path)
  model = mmbrdf_oct ("load_model", path);
endfunction
