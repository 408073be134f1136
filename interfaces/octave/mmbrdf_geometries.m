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
  geometries_rad = zeros (nargin, numel (varargin{1}));
  for k = 1:nargin
    geometries_rad(k, :) = double (varargin{k}(:)) * (pi / 180);
  endfor
endfunction
