#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Orfeo ToolBox 8.1.1 (Debian 12): alpha of SARDecompositions depends on the unit of the image. Eigenvalues that are closer than 1e-6,
# whatever their size, all get the angle of one eigenvector: of a scene whose alpha is 42.4 degrees it is another where amplitudes
# are 1000 times smaller, and of two mechanisms of the same power it is that of one of them in any unit. The anisotropy sinks
# with the unit, too. Multiply amplitudes by 1000 first. Fails if this changes. Takes numpy as it is in Debian 12.
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

scenes = {"unequal": (1, 0.8, 0.5), "two alike": (1, 1, 0.5)}
scene, factor = sys.argv[1], float(sys.argv[2])
a, b, c = scenes[scene]
# columns: trihedral, dihedral at 0, dihedral at 45 degrees
hh, hv, vv = (np.array([row] * 3, complex) for row in ((a, b, 0), (0, 0, c), (a, -b, 0)))
if len(sys.argv) == 3:
    for name, image in (("hh", hh), ("hv", hv), ("vv", vv)):
        (factor * image).tofile(name + ".img")
        with open(name + ".hdr", "w") as f:
            f.write("ENVI\nsamples = 3\nlines = 3\nbands = 1\ndata type = 9\ninterleave = bip\nbyte order = 0\n")
else:
    k = np.stack([hh + vv, hh - vv, 2 * hv]).reshape(3, -1)
    power, vectors = np.linalg.eigh(k @ k.conj().T)
    alpha = power / power.sum() @ np.degrees(np.arccos(np.minimum(abs(vectors[0]), 1)))
    anisotropy = (power[1] - power[0]) / (power[1] + power[0])
    entropy, *got = np.fromfile("haa", complex).reshape(3, 3, 3)[:, 1, 1].real
    print(f"{scene}, amplitudes times {factor:g}: entropy {entropy:.3f}, alpha {got[0]:.2f} (is {alpha:.2f}),",
          f"anisotropy {got[1]:.3f} (is {anisotropy:.3f})")
PY
for scene in unequal "two alike"; do
  for factor in 1000 1 0.001; do
    /usr/bin/python3 images.py "$scene" $factor
    usr/bin/otbcli SARDecompositions -decomp haa -inco.kernelsize 1 -inhh hh.img -inhv hv.img -invv vv.img -out haa.hdr cdouble >>log
    /usr/bin/python3 images.py "$scene" $factor read
  done
done | tee out
cat >expected <<'END'
unequal, amplitudes times 1000: entropy 0.884, alpha 42.38 (is 42.38), anisotropy 0.438 (is 0.438)
unequal, amplitudes times 1: entropy 0.884, alpha 42.38 (is 42.38), anisotropy 0.438 (is 0.438)
unequal, amplitudes times 0.001: entropy 0.884, alpha 90.00 (is 42.38), anisotropy 0.163 (is 0.438)
two alike, amplitudes times 1000: entropy 0.878, alpha 90.00 (is 50.00), anisotropy 0.600 (is 0.600)
two alike, amplitudes times 1: entropy 0.878, alpha 90.00 (is 50.00), anisotropy 0.600 (is 0.600)
two alike, amplitudes times 0.001: entropy 0.878, alpha 90.00 (is 50.00), anisotropy 0.273 (is 0.600)
END
cmp expected out && echo "Orfeo ToolBox 8.1.1: seen as described"
