#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# scipy 1.10.1 (Debian 12): RectSphereBivariateSpline, which interpolates on a sphere and is periodic in azimuth, neither wraps
# nor refuses an azimuth outside the turn that begins at its first one: it answers with the value at the end of that, without
# a word. A colatitude outside is an error. So a table over -pi..pi that is asked at 5 rad has the value of pi: wrap first.
# Fails if this changes. Takes numpy and scipy's libraries as they are in Debian 12.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root python3-scipy=1.10.1-2
dpkg -x python3-scipy_*.deb .
cat >ask.py <<'PY'
import numpy as np
import scipy
from scipy.interpolate import RectSphereBivariateSpline

print("scipy", scipy.__version__)
colatitude = np.linspace(0.1, 3.0, 30)
for first in (-np.pi, 0.0):
    azimuth = first + np.linspace(0, 2 * np.pi, 72, endpoint=False)
    table = RectSphereBivariateSpline(colatitude, azimuth, np.sin(colatitude)[:, None] * np.cos(azimuth))
    for asked in (-1.5, 2.5, 5.0):
        print(f"azimuths from {first:.3f}, asked at {asked}: {table.ev(np.pi / 2, asked):.3f} where {np.cos(asked):.3f} is right")
try:
    table.ev(3.2, 1.0)
except ValueError as error:
    print("colatitude of 3.2:", error)
PY
PYTHONPATH=usr/lib/python3/dist-packages /usr/bin/python3 -W error ask.py | tee out
cat >expected <<'END'
scipy 1.10.1
azimuths from -3.142, asked at -1.5: 0.071 where 0.071 is right
azimuths from -3.142, asked at 2.5: -0.801 where -0.801 is right
azimuths from -3.142, asked at 5.0: -1.000 where 0.284 is right
azimuths from 0.000, asked at -1.5: 1.000 where 0.071 is right
azimuths from 0.000, asked at 2.5: -0.801 where -0.801 is right
azimuths from 0.000, asked at 5.0: 0.284 where 0.284 is right
colatitude of 3.2: requested theta out of bounds.
END
cmp expected out && echo "scipy 1.10.1: seen as described"
