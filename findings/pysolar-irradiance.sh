#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# pysolar 0.10 (Debian 12): irradiances of a clear sky in its module util are not those of any sun. The direct one takes the sine of
# the altitude in degrees as if they were radians, and the declination in degrees for an optical depth: at noon it is nothing in
# June and -2e20 W/m2 in January. The global one is more in June than there is above the air. The distance to the sun is 1 on all
# days. Altitudes, get_sun_earth_distance of solar, extraterrestrial_irrad and get_radiation_direct are good. Fails if this
# changes. Takes numpy as it is in Debian 12.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root python3-pysolar=0.10+repack-3
dpkg -x python3-pysolar_*.deb .
cat >ask.py <<'PY'
from datetime import datetime, timezone

from pysolar import radiation, solar, util
from pysolar.solartime import get_julian_ephemeris_century, get_julian_ephemeris_day, get_julian_ephemeris_millennium

for month, day in ((1, 4), (3, 21), (6, 21), (7, 4)):
    at = (50.0, 0.0, datetime(2020, month, day, 12, tzinfo=timezone.utc))
    altitude = solar.get_altitude(*at)
    time = get_julian_ephemeris_millennium(get_julian_ephemeris_century(get_julian_ephemeris_day(at[2])))
    print(f"{at[2]:%m-%d} noon at 50 degrees north: altitude {altitude:.1f}, distance {solar.get_sun_earth_distance(time):.4f},",
          f"of util {util.mean_earth_sun_distance(at[2]):.4f}")
    print(f"  horizontal above the air {util.extraterrestrial_irrad(*at):.0f} W/m2; direct beam {radiation.get_radiation_direct(at[2], altitude):.0f},",
          f"of util {util.direct_underclear(*at):.1e}, global {util.global_irradiance_clear(*at):.4g}")
PY
PYTHONPATH=usr/lib/python3/dist-packages /usr/bin/python3 -W ignore ask.py | tee out
cat >expected <<'END'
01-04 noon at 50 degrees north: altitude 17.3, distance 0.9832, of util 1.0000
  horizontal above the air 419 W/m2; direct beam 773, of util -1.8e+20, global -1.781e+20
03-21 noon at 50 degrees north: altitude 40.5, distance 0.9963, of util 1.0000
  horizontal above the air 885 W/m2; direct beam 914, of util 4.2e+02, global 1260
06-21 noon at 50 degrees north: altitude 63.4, distance 1.0163, of util 1.0000
  horizontal above the air 1183 W/m2; direct beam 862, of util 1.8e-15, global 1308
07-04 noon at 50 degrees north: altitude 62.8, distance 1.0167, of util 1.0000
  horizontal above the air 1175 W/m2; direct beam 858, of util -3.2e-16, global 1295
END
cmp expected out && echo "pysolar 0.10: seen as described"
