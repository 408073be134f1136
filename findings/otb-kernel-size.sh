#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Orfeo ToolBox 8.1.1 (Debian 12): inco.kernelsize of SARDecompositions, which its help calls the size of the averaging window, is
# what the window reaches to each side: the default of 3 averages 7 x 7 pixels and not 3 x 3. So one dihedral among trihedrals
# lifts the entropy of 49 pixels, by less than 9 would have. Fails if this changes. Takes numpy as it is in Debian 12.
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

n = 15
if len(sys.argv) == 1:
    hh, hv, vv = np.ones((n, n), complex), np.zeros((n, n), complex), np.ones((n, n), complex)
    vv[n // 2, n // 2] = -1
    for name, image in (("hh", hh), ("hv", hv), ("vv", vv)):
        image.tofile(name + ".img")
        with open(name + ".hdr", "w") as f:
            f.write(f"ENVI\nsamples = {n}\nlines = {n}\nbands = 1\ndata type = 9\ninterleave = bip\nbyte order = 0\n")
else:
    entropy = np.fromfile("haa", complex).reshape(3, n, n).real[0]
    mixed = np.argwhere(entropy > 1e-6)
    rows, columns = np.ptp(mixed, axis=0) + 1
    size = int(sys.argv[1])
    of = {looks: -sum(p * np.log(p) / np.log(3) for p in (1 / looks, 1 - 1 / looks)) for looks in (size ** 2, (2 * size + 1) ** 2)}
    print(f"inco.kernelsize {size}: {rows} x {columns} pixels are mixed, entropy {entropy[n // 2, n // 2]:.4f};",
          "one pixel of", ", ".join(f"{looks} has {h:.4f}" for looks, h in of.items()))
PY
/usr/bin/python3 images.py
for size in 2 3 5; do
  usr/bin/otbcli SARDecompositions -decomp haa -inco.kernelsize $size -inhh hh.img -inhv hv.img -invv vv.img -out haa.hdr cdouble >>log
  /usr/bin/python3 images.py $size
done | tee out
cat >expected <<'END'
inco.kernelsize 2: 5 x 5 pixels are mixed, entropy 0.1529; one pixel of 4 has 0.5119, 25 has 0.1529
inco.kernelsize 3: 7 x 7 pixels are mixed, entropy 0.0907; one pixel of 9 has 0.3175, 49 has 0.0907
inco.kernelsize 5: 11 x 11 pixels are mixed, entropy 0.0436; one pixel of 25 has 0.1529, 121 has 0.0436
END
cmp expected out && echo "Orfeo ToolBox 8.1.1: seen as described"
