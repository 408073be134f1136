#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# ncdf4 1.21 of R (Debian 12): ncvar_get makes NA of every float that differs from the fill value by less than 1e-5 of it, and
# not only of the fill value itself, without a word: with a fill value of -1, normalized elements of a Mueller matrix of -0.999995,
# as a mirror has them, are gone, and with one of 360 an azimuth of 359.997. netCDF4 of Python has them; NaN as the fill
# value, or one far from all data, is good. Integers are not touched.
# Fails if this changes. Takes R, Python's netCDF4 and the library netCDF as they are in Debian 12.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root r-cran-ncdf4=1.21-1
dpkg -x r-cran-ncdf4_*.deb .
cat >make.py <<'PY'
import netCDF4
import numpy as np

with netCDF4.Dataset("m.nc", "w") as f:
    f.createDimension("point", 5)
    m33 = f.createVariable("m33", "f8", ("point",), fill_value=-1.0)
    m33[:] = np.ma.masked_equal([-1, -1.000005, -0.999995, -0.99998, 0.5], -1)
with netCDF4.Dataset("m.nc") as f:
    print("netCDF4", *f["m33"][:])
PY
cat >ask.R <<'R'
.libPaths(c("usr/lib/R/site-library", .libPaths()))
f <- ncdf4::nc_open("m.nc")
cat(paste(c("ncdf4", as.vector(ncdf4::ncvar_get(f, "m33"))), collapse = " "), "\n", sep = "")
R
{ /usr/bin/python3 make.py && Rscript ask.R; } | tee out
cat >expected <<'END'
netCDF4 -- -1.000005 -0.999995 -0.99998 0.5
ncdf4 NA NA NA -0.99998 0.5
END
cmp expected out && echo "ncdf4 1.21: seen as described"
