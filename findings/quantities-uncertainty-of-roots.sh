#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# quantities 0.13.0 (Debian 12): an UncertainQuantity keeps its uncertainty in sums, products and powers, but sqrt, exp and log
# of it have an uncertainty of 0, without a warning: 2 +/- 0.1 to the power of 0.5 is 1.414 +/- 0.035, its np.sqrt 1.414 +/- 0.
# And x * x is +/- 0.28 where x ** 2 is +/- 0.4. Budgets of radiances lose their terms. Fails if this changes.
# Takes numpy as it is in Debian 12.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root python3-quantities=0.13.0-2
dpkg -x python3-quantities_*.deb .
cat >ask.py <<'PY'
import numpy as np
import quantities

def show(what, x):
    print(f"{what}: {x.magnitude:.4f} +/- {x.uncertainty.magnitude:.4f}")

x = quantities.UncertainQuantity(2.0, "dimensionless", 0.1)
print("quantities", quantities.__version__)
show("x", x)
show("1 / x", 1 / x)
show("x ** 0.5", x ** 0.5)
show("sqrt(x)", np.sqrt(x))
show("exp(x)", np.exp(x))
show("log(x)", np.log(x))
show("x ** 2", x ** 2)
show("x * x", x * x)
PY
PYTHONPATH=usr/lib/python3/dist-packages /usr/bin/python3 -W error ask.py | tee out
cat >expected <<'END'
quantities 0.13.0
x: 2.0000 +/- 0.1000
1 / x: 0.5000 +/- 0.0250
x ** 0.5: 1.4142 +/- 0.0354
sqrt(x): 1.4142 +/- 0.0000
exp(x): 7.3891 +/- 0.0000
log(x): 0.6931 +/- 0.0000
x ** 2: 4.0000 +/- 0.4000
x * x: 4.0000 +/- 0.2828
END
cmp expected out && echo "quantities 0.13.0: seen as described"
