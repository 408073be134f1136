#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Orfeo ToolBox 8.1.1 (Debian 12): mcovariancetocoherencydegree of SARPolarMatrixConvert leaves a degree of coherence as it was in the
# pixel before where a power is 1e-6 or less, so that pixels without data, or in small units, have a neighbour's degrees, which
# depend on where they lie. Multiply the covariances by 1e6, and mask zeros. Fails if this changes.
# Takes numpy as it is in Debian 12.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get install -s --no-install-recommends otb-bin=8.1.1+dfsg-1 libotb-apps=8.1.1+dfsg-1 | sed -n 's/^Inst \([^ ]*\) .*/\1/p' >missing
apt-get download -qq -o APT::Sandbox::User=root $(cat missing)
for package in *.deb; do dpkg -x "$package" .; done
LD_LIBRARY_PATH=$(dirname usr/lib/*/libOTBPolarimetry-8.1.so.1):usr/lib
export LD_LIBRARY_PATH
cat >images.py <<'PY'
import sys

import numpy as np


def covariance(hh_vv, factor):
    return factor * np.array([1, 0.5, hh_vv, 1, 0.5, 1], complex)


pixels = {"HH and VV 0.9": covariance(0.9, 1), "0.1 in other units": covariance(0.1, 1e-7), "no data": covariance(0, 0),
          "0.3": covariance(0.3, 1), "0.1 in other units again": covariance(0.1, 1e-7), "0.1": covariance(0.1, 1)}
if sys.argv[1] == "write":
    np.array(list(pixels.values())).tofile("covariance.img")
    with open("covariance.hdr", "w") as f:
        f.write(f"ENVI\nsamples = {len(pixels)}\nlines = 1\nbands = 6\ndata type = 9\ninterleave = bip\nbyte order = 0\n")
else:
    for name, degree in zip(pixels, np.fromfile("degree", complex).reshape(3, -1)[0].real):
        print(f"{name}: {degree:.2f} is given")
PY
/usr/bin/python3 images.py write
usr/bin/otbcli SARPolarMatrixConvert -conv mcovariancetocoherencydegree -inc covariance.img -outc degree.hdr cdouble >log
/usr/bin/python3 images.py read | tee out
cat >expected <<'END'
HH and VV 0.9: 0.90 is given
0.1 in other units: 0.90 is given
no data: 0.90 is given
0.3: 0.30 is given
0.1 in other units again: 0.30 is given
0.1: 0.10 is given
END
cmp expected out && echo "Orfeo ToolBox 8.1.1: seen as described"
