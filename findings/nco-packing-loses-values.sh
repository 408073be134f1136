#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# NCO 5.1.4 (Debian 12): packing by ncpdq -P loses values without a word. A value whose distance from the middle of the range is
# the fill value comes out missing: of 1, 2, missing, 3 with a fill value of -1 the 1 is gone, as 1 - 2 = -1. And where the fill
# value is NaN, as xarray writes it, what is missing comes out as the middle of the range, here 2. With -999 both are good.
# Fails if this changes. Takes Python's netCDF4 and NCO's libraries but GSL as they are in Debian 12.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root nco=5.1.4-1+deb12u1 libgsl27=2.7.1+dfsg-5+deb12u1 libgslcblas0=2.7.1+dfsg-5+deb12u1
for package in *.deb; do dpkg -x "$package" .; done
cat >files.py <<'PY'
import sys

import netCDF4
import numpy as np

with netCDF4.Dataset(sys.argv[1], "r" if len(sys.argv) > 2 else "w") as f:
    if len(sys.argv) == 2:
        f.createDimension("point", 4)
        for name, fill in (("a", -999.0), ("b", -1.0), ("c", np.nan)):
            f.createVariable(name, "f8", ("point",), fill_value=fill)[:] = np.ma.masked_array([1.0, 2.0, 0.0, 3.0], [0, 0, 1, 0])
    for name in ("a", "b", "c"):
        values = (f"{x:.3f}" if x is not np.ma.masked else "--" for x in f[name][:])
        print(sys.argv[-1], "fill", f[name]._FillValue, "values", *values)
PY
{
  /usr/bin/python3 files.py in.nc
  LD_LIBRARY_PATH=$(dirname usr/lib/*/libgsl.so.27):usr/lib/nco usr/bin/ncpdq -O -P all_new in.nc packed.nc 2>&1
  /usr/bin/python3 -W ignore files.py packed.nc packed
} | tee out
cat >expected <<'END'
in.nc fill -999.0 values 1.000 2.000 -- 3.000
in.nc fill -1.0 values 1.000 2.000 -- 3.000
in.nc fill nan values 1.000 2.000 -- 3.000
packed fill -999.0 values 1.000 2.000 -- 3.000
packed fill -1.0 values -- 2.000 -- 3.000
packed fill nan values 1.000 2.000 2.000 3.000
END
cmp expected out && echo "NCO 5.1.4: seen as described"
