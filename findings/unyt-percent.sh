#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# unyt 2.9.3 (Debian 12): log10, log, exp and sin take 50 % for the number 50, without a word, though 50 % + 1 is 150 % and
# 50 % in units of 1 is 0.5. The optical density of a filter of 50 % is -1.70 and not 0.30, and the decibels are off by 20.
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

t = unyt.unyt_quantity(50.0, "percent")
print("unyt", unyt.__version__)
print("50 % + 1:", t + 1)
print("-log10(0.5):", f"{-np.log10(t.to('dimensionless')):.4f}")
print("-log10(50 %):", f"{-np.log10(t):.4f}")
print("exp(50 %):", f"{np.exp(t):.4g}", "and of 0.5:", f"{np.exp(0.5):.4g}")
PY
PYTHONPATH=usr/lib/python3/dist-packages /usr/bin/python3 -W error ask.py | tee out
cat >expected <<'END'
unyt v2.9.3
50 % + 1: 150.0 %
-log10(0.5): 0.3010
-log10(50 %): -1.6990
exp(50 %): 5.185e+21 and of 0.5: 1.649
END
cmp expected out && echo "unyt 2.9.3: seen as described"
