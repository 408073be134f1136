#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# pymap3d 2.9.1 (Debian 12): enu2aer, which makes azimuth and elevation of east, north and up, writes 0 for every component
# below 1e-3, meant as a millimetre, into the caller's own arrays, and gives the azimuth of that. Unit vectors, as directions
# are, so lose their azimuth near the normal, and up to 0.06 degrees elsewhere, and are changed after the call, without a
# word. Vectors of a length of 1000 are good. Fails if this changes. Takes numpy as it is in Debian 12.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root python3-pymap3d=2.9.1-1
dpkg -x python3-pymap3d_*.deb .
cat >ask.py <<'PY'
import numpy as np
import pymap3d

elevation = np.array([45.0, 89.93, 89.95])
azimuth = np.array([0.05, 30.0, 40.0])
east, north, up = (np.cos(np.radians(elevation)) * np.sin(np.radians(azimuth)),
                   np.cos(np.radians(elevation)) * np.cos(np.radians(azimuth)), np.sin(np.radians(elevation)))
print("east ", *np.round(east, 6))
print("north", *np.round(north, 6))
for scale in (1000.0, 1.0):
    vectors = [scale * c for c in (east, north, up)]
    a, e, _ = pymap3d.enu2aer(*vectors)
    print(f"length {scale:g}: azimuth", *np.round(a, 4), "elevation", *np.round(e, 4))
print("east of the caller afterwards ", *np.round(vectors[0] / scale, 6))
print("north of the caller afterwards", *np.round(vectors[1] / scale, 6))
PY
PYTHONPATH=usr/lib/python3/dist-packages /usr/bin/python3 -W error ask.py | tee out
cat >expected <<'END'
east  0.000617 0.000611 0.000561
north 0.707107 0.001058 0.000668
length 1000: azimuth 0.05 30.0 40.0 elevation 45.0 89.93 89.95
length 1: azimuth 0.0 0.0 0.0 elevation 45.0 89.9394 90.0
east of the caller afterwards  0.0 0.0 0.0
north of the caller afterwards 0.707107 0.001058 0.0
END
cmp expected out && echo "pymap3d 2.9.1: seen as described"
