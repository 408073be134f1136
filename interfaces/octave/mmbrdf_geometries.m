## SPDX-License-Identifier: BSD-3-Clause
## geometries_rad = mmbrdf_geometries (angle_deg, ...): angles in degrees as the library takes them: a row of radians for each.
function geometries_rad = mmbrdf_geometries (varargin)
  rows = cellfun (@(angle) double (angle(:)).', mmbrdf_angles (varargin{:}), "UniformOutput", false);
  geometries_rad = vertcat (rows{:}) * (pi / 180);
endfunction
