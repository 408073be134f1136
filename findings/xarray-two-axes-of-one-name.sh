#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# xarray 2023.01.0 (Debian 12) takes an array with two axes of one name, as Mueller matrices over (point, stokes, stokes) are
# in files, and then an index of the second of them is applied to both: M[0, 0, 1] is element (1, 1), not (0, 1), without an
# error or a warning. Different names, such as row and column, are good. Fails if this changes.
# Takes numpy and pandas as they are installed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root python3-xarray=2023.01.0-1.1
dpkg -x python3-xarray_*.deb .
cat >ask.py <<'PY'
import numpy as np
import xarray

values = np.arange(1.0, 17).reshape(1, 4, 4)
for axes in (("point", "stokes", "stokes"), ("point", "row", "column")):
    m = xarray.DataArray(values, dims=axes)
    print(axes, "M[0, 0, 1] =", m[0, 0, 1].item(), "of", values[0, 0, 1])
PY
PYTHONPATH=usr/lib/python3/dist-packages /usr/bin/python3 -W error ask.py | tee out
cat >expected <<'END'
('point', 'stokes', 'stokes') M[0, 0, 1] = 6.0 of 2.0
('point', 'row', 'column') M[0, 0, 1] = 2.0 of 2.0
END
cmp expected out && echo "xarray 2023.01.0: seen as described"
