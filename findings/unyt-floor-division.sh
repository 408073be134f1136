#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# unyt 2.9.3 (Debian 12): // and divmod of two quantities of one dimension but different units compare the numbers as they are:
# 1 rad // 10 degrees is 0 where 5 is right, and divmod says 0 rad, rest 1 rad, while % converts and has a rest of 0.127 rad.
# No error, no warning. So bins of angles or wavelengths by // are wrong where the step has another unit; floor(a / b) is good.
# Fails if this changes. Takes numpy and sympy as they are in Debian 12.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root python3-unyt=2.9.3-2
dpkg -x python3-unyt_*.deb .
cat >ask.py <<'PY'
import numpy as np
import unyt

print("unyt", unyt.__version__)
for (a, unit), (b, other) in (((1.0, "rad"), (10.0, "degree")), ((2.0, "um"), (300.0, "nm"))):
    x, step = unyt.unyt_quantity(a, unit), unyt.unyt_quantity(b, other)
    quotient, rest = np.divmod(x, step)
    print(f"{x} and {step}: // {x // step}, divmod {quotient} and {rest:.4g}, % {x % step:.4g}, floor(a / b) {np.floor(x / step)}")
PY
PYTHONPATH=usr/lib/python3/dist-packages /usr/bin/python3 -W error ask.py | tee out
cat >expected <<'END'
unyt v2.9.3
1.0 rad and 10.0 degree: // 0.0 dimensionless, divmod 0.0 rad and 1 rad, % 0.1273 rad, floor(a / b) 5.0 dimensionless
2.0 μm and 300.0 nm: // 0.0 dimensionless, divmod 0.0 μm and 2 μm, % 0.2 μm, floor(a / b) 6.0 dimensionless
END
cmp expected out && echo "unyt 2.9.3: seen as described"
