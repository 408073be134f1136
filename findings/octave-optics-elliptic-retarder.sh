#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# octave-optics 0.1.4 (Debian 12): mueller_homogeneous_elliptic_retarder returns a symmetric matrix, so that it is no rotation
# of the Poincaré sphere: of a linear retarder it has one element with the wrong sign beside mueller_linretarder, it takes
# away polarization, and no scatterer can have it. Only delays of 0 and 180 degrees are right. Its diattenuator is good.
# Takes Octave as it is installed. Fails if this changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root octave-optics=0.1.4-4
dpkg -x octave-optics_*.deb .
cat >ask.m <<'M'
addpath("usr/share/octave/packages/optics-0.1.4");
linear = mueller_linretarder(pi/3);
elliptic = mueller_homogeneous_elliptic_retarder(1, pi/3, 0, 0);
for i = 3:4
  printf("row %d: linear %8.4f %8.4f, elliptic of azimuth 0, ellipticity 0 %8.4f %8.4f\n", i, linear(i, 3:4), elliptic(i, 3:4));
end
for delay = [60 90 180]
  m = mueller_homogeneous_elliptic_retarder(1, delay * pi / 180, 0.2, 0.3);
  seen = m * [1; 0; cos(1); sin(1)];
  printf("delay %3d degrees: determinant %6.3f, symmetric %d, fully polarized light leaves with %.3f\n", delay, det(m), ...
         norm(m - m') < 1e-12, norm(seen(2:4)) / seen(1));
end
M
octave-cli -q ask.m 2>ask.err | tee out
cat >expected <<'END'
row 3: linear   0.5000  -0.8660, elliptic of azimuth 0, ellipticity 0   0.5000  -0.8660
row 4: linear   0.8660   0.5000, elliptic of azimuth 0, ellipticity 0  -0.8660   0.5000
delay  60 degrees: determinant -0.172, symmetric 1, fully polarized light leaves with 0.413
delay  90 degrees: determinant -0.485, symmetric 1, fully polarized light leaves with 0.683
delay 180 degrees: determinant  1.000, symmetric 1, fully polarized light leaves with 1.000
END
cmp expected out && echo "octave-optics 0.1.4: seen as described"
