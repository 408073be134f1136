#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# pint 0.19.2 (Debian 12) makes zero of the unit "sr-1", which is how CF writes that of a BRDF: UnitRegistry()("sr-1") is
# steradian minus 1, and as a steradian counts as 1 that is 0, without an error or a warning. "sr^-1" and "1/sr" are good;
# Unit("sr-1") is at least a TypeError. Fails if this changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root python3-pint=0.19.2-1
dpkg -x python3-pint_*.deb .
cat >ask.py <<'PY'
import pint

units = pint.UnitRegistry()
print("pint", pint.__version__)
for text in ("sr^-1", "1/sr", "sr-1"):
    print(f"0.3 in {text!r}:", 0.3 * units(text))
try:
    units.Unit("sr-1")
except TypeError as error:
    print("Unit('sr-1'): TypeError:", error)
PY
PYTHONPATH=usr/lib/python3/dist-packages /usr/bin/python3 ask.py | tee out
cat >expected <<'END'
pint 0.19.2
0.3 in 'sr^-1': 0.3 / steradian
0.3 in '1/sr': 0.3 / steradian
0.3 in 'sr-1': 0.0 dimensionless
Unit('sr-1'): TypeError: unsupported operand type(s) for -: 'ParserHelper' and 'int'
END
cmp expected out && echo "pint 0.19.2: seen as described"
