#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# octave-optics 0.1.4 (Debian 12): mueller_checkmueller, documented to check whether a Mueller matrix is physically valid, asks
# whether its determinant is exactly 1. So it refuses the package's own polarizers, absorbers, depolarizers and diattenuators,
# and by rounding its wave plates, and accepts a matrix that makes light brighter than it was.
# Takes Octave as it is installed. Fails if this changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root octave-optics=0.1.4-4
dpkg -x octave-optics_*.deb .
cat >ask.m <<'M'
addpath("usr/share/octave/packages/optics-0.1.4");
printf("polarizer %d\n", mueller_checkmueller(mueller_linpolarizer()));
printf("absorber %d\n", mueller_checkmueller(mueller_absorber(0.3)));
printf("depolarizer %d\n", mueller_checkmueller(mueller_depolarizer(0.3)));
printf("wave plate of 0.13 waves %d\n", mueller_checkmueller(mueller_waveplate(0.13, "wav")));
printf("unity %d\n", mueller_checkmueller(mueller_unity()));
printf("diag(1, 2, 0.5, 1), which doubles the polarized part: %d\n", mueller_checkmueller(diag([1 2 0.5 1])));
M
octave-cli -q ask.m 2>ask.err | tee out
cat >expected <<'END'
polarizer 0
absorber 0
depolarizer 0
wave plate of 0.13 waves 0
unity 1
diag(1, 2, 0.5, 1), which doubles the polarized part: 1
END
cmp expected out && echo "octave-optics 0.1.4: seen as described"
