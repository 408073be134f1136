#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Orfeo ToolBox 8.1.1 (Debian 12): SARPolarSynth takes the complex conjugate of the receiving antenna, where its handbook has
# |B^T S A|^2. So with circular antennas "co" is what is received across, and "cross" what is received alike: a trihedral, which
# turns the handedness round, answers left with left. SARPolarMatrixConvert has it right for the same S. Linear antennas
# are good; for others mode "none" with the other sign of khir is. Fails if this changes. Takes numpy as it is in Debian 12.
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

targets = {"trihedral": (1, 0, 0, 1), "dihedral": (1, 0, 0, -1), "left helix": (0.5, -0.5j, -0.5j, -0.5), "dipole at 0": (1, 0, 0, 0)}
S = np.array(list(targets.values()), complex)
if sys.argv[1] == "write":
    for name, image in (("all", S), ("hh", S[:, :1]), ("hv", S[:, 1:2]), ("vh", S[:, 2:3]), ("vv", S[:, 3:])):
        image.tofile(name + ".img")
        with open(name + ".hdr", "w") as f:
            f.write(f"ENVI\nsamples = {len(S)}\nlines = 1\nbands = {image.shape[1]}\ndata type = 9\ninterleave = bip\nbyte order = 0\n")
else:
    co, cross, co_turned, cross_turned, linear = (np.fromfile(name) for name in ("ll", "lr", "ll_turned", "lr_turned", "linear"))
    convert = np.fromfile("circular", complex).reshape(10, -1).real
    left, linear_45 = np.array([1, 1j]) / np.sqrt(2), np.array([1, 1]) / np.sqrt(2)
    for i, name in enumerate(targets):
        ll, lr, p45 = (abs(b @ S[i].reshape(2, 2) @ a) ** 2
                       for b, a in ((left, left), (left.conj(), left), (linear_45, linear_45)))
        print(f"{name:11s} LL LR: |B^T S A|^2 {ll:.2f} {lr:.2f}, MatrixConvert {convert[0, i]:.2f} {convert[4, i]:.2f},",
              f"Synth {co[i]:.2f} {cross[i]:.2f}, khir turned {co_turned[i]:.2f} {cross_turned[i]:.2f};",
              f"45 degrees {p45:.2f} {linear[i]:.2f}")
PY
/usr/bin/python3 images.py write
synth() { usr/bin/otbcli SARPolarSynth -in all.img -out "$@" >>log; }
synth ll.hdr double -psii 0 -khii 45 -mode co
synth lr.hdr double -psii 0 -khii 45 -mode cross
synth ll_turned.hdr double -psii 0 -khii 45 -psir 0 -khir -45
synth lr_turned.hdr double -psii 0 -khii 45 -psir 90 -khir 45
synth linear.hdr double -psii 45 -khii 0 -mode co
usr/bin/otbcli SARPolarMatrixConvert -conv bsinclairtocircovariance -inhh hh.img -inhv hv.img -invh vh.img -invv vv.img \
  -outc circular.hdr cdouble >>log
/usr/bin/python3 images.py read | tee out
cat >expected <<'END'
trihedral   LL LR: |B^T S A|^2 0.00 1.00, MatrixConvert 0.00 1.00, Synth 1.00 0.00, khir turned 0.00 1.00; 45 degrees 1.00 1.00
dihedral    LL LR: |B^T S A|^2 1.00 0.00, MatrixConvert 1.00 0.00, Synth 0.00 1.00, khir turned 1.00 0.00; 45 degrees 0.00 0.00
left helix  LL LR: |B^T S A|^2 1.00 0.00, MatrixConvert 1.00 0.00, Synth 0.00 1.00, khir turned 1.00 0.00; 45 degrees 0.25 0.25
dipole at 0 LL LR: |B^T S A|^2 0.25 0.25, MatrixConvert 0.25 0.25, Synth 0.25 0.25, khir turned 0.25 0.25; 45 degrees 0.25 0.25
END
cmp expected out && echo "Orfeo ToolBox 8.1.1: seen as described"
