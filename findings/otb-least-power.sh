#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Orfeo ToolBox 8.1.1 (Debian 12): the least power and the least degree of polarization that muellertopoldegandpower of
# SARPolarMatrixConvert gives for a Mueller matrix are those of the last polarization that it tries, circular light with S4 = +1,
# and not the least of all. A linear polarizer lets 0.5 through at least. The greatest are good. Fails if this changes.
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

matrices = {"polarizer at 0        ": [[0.5, 0.5, 0, 0], [0.5, 0.5, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]],
            "circular polarizer +  ": [[0.5, 0, 0, 0.5], [0, 0, 0, 0], [0, 0, 0, 0], [0.5, 0, 0, 0.5]],
            "circular polarizer -  ": [[0.5, 0, 0, -0.5], [0, 0, 0, 0], [0, 0, 0, 0], [-0.5, 0, 0, 0.5]],
            "depolarizer .1, .2, .7": np.diag([1, 0.1, 0.2, 0.7])}
if sys.argv[1] == "write":
    np.array(list(matrices.values()), float).tofile("mueller.img")
    with open("mueller.hdr", "w") as f:
        f.write(f"ENVI\nsamples = {len(matrices)}\nlines = 1\nbands = 16\ndata type = 5\ninterleave = bip\nbyte order = 0\n")
else:
    # the grid of the program: steps of 5 degrees in ellipticity and orientation
    tau, psi = (2 * np.radians(x) for x in np.meshgrid(np.arange(-45, 46, 5), np.arange(-90, 91, 5)))
    states = np.stack([np.ones_like(tau), np.cos(psi) * np.cos(tau), np.sin(psi) * np.cos(tau), np.sin(tau)]).reshape(4, -1)
    for (name, matrix), got in zip(matrices.items(), np.fromfile("power").reshape(4, -1).T):
        out = np.array(matrix) @ states
        power = out[0]
        degree = np.linalg.norm(out[1:], axis=0)[power > 1e-6] / power[power > 1e-6]
        print(f"{name} power {abs(power.min()):.2f} to {power.max():.2f}, given %.2f to %.2f;" % tuple(got[:2]),
              f"degree of polarization {degree.min():.2f} to {degree.max():.2f}, given %.2f to %.2f" % tuple(got[2:]))
PY
/usr/bin/python3 images.py write
usr/bin/otbcli SARPolarMatrixConvert -conv muellertopoldegandpower -inf mueller.img -outf power.hdr double >log
/usr/bin/python3 images.py read | tee out
cat >expected <<'END'
polarizer at 0         power 0.00 to 1.00, given 0.50 to 1.00; degree of polarization 1.00 to 1.00, given 1.00 to 1.00
circular polarizer +   power 0.00 to 1.00, given 1.00 to 1.00; degree of polarization 1.00 to 1.00, given 1.00 to 1.00
circular polarizer -   power 0.00 to 1.00, given 0.00 to 1.00; degree of polarization 1.00 to 1.00, given 0.00 to 1.00
depolarizer .1, .2, .7 power 1.00 to 1.00, given 1.00 to 1.00; degree of polarization 0.10 to 0.70, given 0.70 to 0.70
END
cmp expected out && echo "Orfeo ToolBox 8.1.1: seen as described"
