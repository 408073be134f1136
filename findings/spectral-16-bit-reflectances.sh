#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Spectral Python 0.22.4 (Debian 12): spectral_angles squares 16-bit integers as 16-bit integers, and noise_from_diffs subtracts them so.
# Reflectances times 10000, as images of many bands are kept, have angles of 0 to every spectrum, or NaN, and, unsigned, a noise of
# 5.7 times the signal, without an error. load() gives floats, and is good; a part of the file, and open_memmap, give
# what the file holds. calc_stats, ace, rx and msam convert. Fails if this changes. Takes numpy as it is in Debian 12.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root python3-spectral=0.22.4-1
dpkg -x python3-spectral_*.deb .
cat >ask.py <<'PY'
import numpy as np
import spectral
from spectral.io import envi

# reflectances of one material with a noise of 2 %, and endmembers: this material and another
wavelength = np.linspace(0, 1, 50)
materials = np.array([0.35 + 0.2 * np.sin(5 * wavelength), 0.35 + 0.2 * np.cos(7 * wavelength)])
image = materials[0] * (1 + 0.02 * np.random.default_rng(1).standard_normal((40, 40, 50)))
for kind in ("int16", "uint16"):
    envi.save_image("image.hdr", np.round(10000 * image).astype(kind), dtype=kind, force=True)
    opened = envi.open("image.hdr")
    for how, read in (("load()", opened.load()), ("[:, :]", opened[:, :])):
        angles = np.degrees(spectral.spectral_angles(read, 10000 * materials))
        own, other = ("%.1f to %.1f" % (np.nanmin(a), np.nanmax(a)) for a in (angles[..., 0], angles[..., 1]))
        noise = np.sqrt(np.diag(spectral.noise_from_diffs(read).cov)) / read.reshape(-1, 50).mean(axis=0)
        print(f"{kind}, read by {how} as {read.dtype}: degrees to its own spectrum {own}, to the other {other},",
              f"NaN {np.isnan(angles).mean():.0%}; noise {np.median(noise):.3f} of the signal")
PY
PYTHONPATH=usr/lib/python3/dist-packages /usr/bin/python3 -W ignore ask.py | tee out
cat >expected <<'END'
int16, read by load() as float32: degrees to its own spectrum 0.7 to 1.6, to the other 38.3 to 39.1, NaN 0%; noise 0.020 of the signal
int16, read by [:, :] as int16: degrees to its own spectrum 0.0 to 0.0, to the other 0.0 to 0.0, NaN 51%; noise 0.020 of the signal
uint16, read by load() as float32: degrees to its own spectrum 0.7 to 1.6, to the other 38.3 to 39.1, NaN 0%; noise 0.020 of the signal
uint16, read by [:, :] as uint16: degrees to its own spectrum 0.0 to 0.0, to the other 0.0 to 0.0, NaN 0%; noise 5.660 of the signal
END
cmp expected out && echo "Spectral Python 0.22.4: seen as described"
