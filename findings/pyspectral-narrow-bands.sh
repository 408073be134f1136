#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# pyspectral 0.12.3 (Debian 12): the solar irradiance in a band is summed in steps of 5 nm, however narrow the band and however fine
# its response and the spectrum, which it takes at these points alone. A band of 2 nm has a flux of 0 and an irradiance of NaN, and
# bands of 10 nm are wrong by up to 4 %, as are reflectances that are made with them. With dlambda=0.0001 it is good. Fails if this
# changes. Takes numpy, scipy and setuptools as they are in Debian 12.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root python3-pyspectral=0.12.3+ds-1
dpkg -x python3-pyspectral_*.deb .
cat >ask.py <<'PY'
import numpy as np
from pyspectral.solar import SolarIrradianceSpectrum

table = "usr/lib/python3/dist-packages/pyspectral/data/e490_00a.dat"
wavelength, irradiance = np.genfromtxt(table, unpack=True)
lines = np.logical_and(wavelength > 0.5, wavelength < 0.6)
print(f"spectrum in steps of {1000 * np.max(np.diff(wavelength[lines])):.1f} nm at most, from 500 to 600 nm")
for centre in (0.532, 0.550):
    for width in (0.002, 0.010, 0.020, 0.050):
        x = np.linspace(centre - width / 2, centre + width / 2, 51)
        band = {"wavelength": x, "response": np.ones_like(x)}
        fine = np.linspace(x[0], x[-1], 20001)
        linear = np.trapz(np.interp(fine, wavelength, irradiance), fine)
        flux = SolarIrradianceSpectrum(table).inband_solarflux(band)
        mean = SolarIrradianceSpectrum(table).inband_solarirradiance(band)
        finer = SolarIrradianceSpectrum(table, dlambda=0.0001).inband_solarflux(band)
        print(f"{1000 * centre:.0f} nm, {1000 * width:.0f} nm wide, even response: flux {flux:.2f} W/m2 ({100 * (flux / linear - 1):+.1f} %),",
              f"irradiance {mean:.0f} W/m2/um; with dlambda=0.0001 {finer:.2f}, trapezoids {linear:.2f}")
PY
PYTHONPATH=usr/lib/python3/dist-packages /usr/bin/python3 -W ignore ask.py | tee out
cat >expected <<'END'
spectrum in steps of 1.0 nm at most, from 500 to 600 nm
532 nm, 2 nm wide, even response: flux 0.00 W/m2 (-100.0 %), irradiance nan W/m2/um; with dlambda=0.0001 3.74, trapezoids 3.75
532 nm, 10 nm wide, even response: flux 18.18 W/m2 (-4.1 %), irradiance 1818 W/m2/um; with dlambda=0.0001 18.96, trapezoids 18.95
532 nm, 20 nm wide, even response: flux 36.44 W/m2 (-2.9 %), irradiance 1822 W/m2/um; with dlambda=0.0001 37.52, trapezoids 37.52
532 nm, 50 nm wide, even response: flux 91.81 W/m2 (-1.7 %), irradiance 1836 W/m2/um; with dlambda=0.0001 93.35, trapezoids 93.36
550 nm, 2 nm wide, even response: flux 0.00 W/m2 (-100.0 %), irradiance nan W/m2/um; with dlambda=0.0001 3.76, trapezoids 3.75
550 nm, 10 nm wide, even response: flux 18.88 W/m2 (+0.8 %), irradiance 1888 W/m2/um; with dlambda=0.0001 18.73, trapezoids 18.73
550 nm, 20 nm wide, even response: flux 37.40 W/m2 (+0.7 %), irradiance 1870 W/m2/um; with dlambda=0.0001 37.13, trapezoids 37.13
550 nm, 50 nm wide, even response: flux 93.47 W/m2 (+0.6 %), irradiance 1869 W/m2/um; with dlambda=0.0001 92.95, trapezoids 92.96
END
cmp expected out && echo "pyspectral 0.12.3: seen as described"
