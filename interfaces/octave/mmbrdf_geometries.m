## SPDX-License-Identifier: BSD-3-Clause
## geometries_rad = mmbrdf_geometries (angle_deg, ...): angles in degrees, numbers or arrays of one size, as the library takes
## them: a row of radians for each.
function geometries_rad = mmbrdf_geometries (varargin)
  for k = 1:nargin
    if (! isnumeric (varargin{k}) || ! isreal (varargin{k}))
      error ("mmbrdf: angle %d must be real numbers", k);
    endif
  endfor
  [different, varargin{:}] = common_size (varargin{:});
  if (different)
    error ("mmbrdf: angles must be numbers or arrays of one size");
  endif
  rows = cellfun (@(angle) double (angle(:)).', varargin, "UniformOutput", false);
  geometries_rad = vertcat (rows{:}) * (pi / 180);
endfunction
