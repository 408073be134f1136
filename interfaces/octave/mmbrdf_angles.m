## SPDX-License-Identifier: BSD-3-Clause
## angles_deg = mmbrdf_angles (angle_deg, ...): numbers or arrays of one size, as a cell of arrays of one size.
function angles_deg = mmbrdf_angles (varargin)
  for k = 1:nargin
    if (! isnumeric (varargin{k}) || ! isreal (varargin{k}))
      error ("mmbrdf: angle %d must be real numbers", k);
    endif
  endfor
  [different, angles_deg{1:nargin}] = common_size (varargin{:});
  if (different)
    error ("mmbrdf: angles must be numbers or arrays of one size");
  endif
endfunction
