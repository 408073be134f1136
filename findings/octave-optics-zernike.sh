#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# octave-optics 0.1.4 (Debian 12) has two sets of Zernike functions of different size: zernike_cartesian and zernike_polar,
# numbered as Noll does, are 1 at the rim and not Noll's orthonormal ones; zernikes_and_derivatives_cartesian_OSA are
# orthonormal. Coefficients from one to the other are off by sqrt(n + 1) or sqrt(2 n + 2), which the help does not say.
# And the radial polynomials are summed in powers of r: of order 50 zernike_R_poly has 11 where 1 is right, without a word.
# Takes Octave as it is installed. Fails if this changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root octave-optics=0.1.4-4
dpkg -x octave-optics_*.deb .
cat >ask.m <<'M'
addpath("usr/share/octave/packages/optics-0.1.4");
x = [0.3 -0.2; 0.1 0.05];
y = [0.4 0.1; -0.6 0.6];
noll = zernike_cartesian(x, y, 15);
osa = zernikes_and_derivatives_cartesian_OSA(x, y, 4);
for j = [2 4 5 11 15]
  [m, n] = zernike_noll_to_mn(j);
  ratio = osa(:, :, (n * (n + 2) + m) / 2 + 1)(:) ./ noll(:, j);
  printf("n %d m %2d: OSA / Noll %.4f\n", n, m, mean(ratio));
end
for n = [20 40 50]
  printf("R of order %d at the rim, 1 is right: %.3g\n", n, polyval(zernike_R_poly(0, n), 1));
end
M
octave-cli -q ask.m 2>ask.err | tee out
cat >expected <<'END'
n 1 m  1: OSA / Noll 2.0000
n 2 m  0: OSA / Noll 1.7321
n 2 m -2: OSA / Noll 2.4495
n 4 m  0: OSA / Noll 2.2361
n 4 m -4: OSA / Noll 3.1623
R of order 20 at the rim, 1 is right: 1
R of order 40 at the rim, 1 is right: 1
R of order 50 at the rim, 1 is right: 11
END
cmp expected out && echo "octave-optics 0.1.4: seen as described"
