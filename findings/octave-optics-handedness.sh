#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# octave-optics 0.1.4 (Debian 12): a quarter-wave plate on light at +45 degrees makes what the package calls left circular in
# Jones calculus, and what it calls right circular in Mueller calculus. Its mirrors differ too: jones_mirror leaves the
# handedness, mueller_mirror turns it. So a chain that is checked in one calculus has the sign of S4 wrong in the other.
# Takes Octave as it is installed. Fails if this changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root octave-optics=0.1.4-4
dpkg -x octave-optics_*.deb .
cat >ask.m <<'M'
addpath("usr/share/octave/packages/optics-0.1.4");
function show(name, jones, stokes)
  overlap = @(state) abs(state' * jones) / norm(state) / norm(jones) > 1 - 1e-12;
  same = @(state) norm(stokes - state) < 1e-12;
  printf("%s: Jones left %d right %d, Mueller left %d right %d\n", name, overlap(jones_cpleft()), overlap(jones_cpright()), ...
         same(stokes_cpleft()), same(stokes_cpright()));
end
show("quarter-wave plate on +45 degrees", jones_waveplate(0.25) * jones_lpplus45(), mueller_waveplate(0.25) * stokes_lpplus45());
show("linear retarder of -90 degrees   ", jones_linretarder(-pi/2) * jones_lpplus45(), mueller_linretarder(-pi/2) * stokes_lpplus45());
show("mirror on left circular light    ", jones_mirror() * jones_cpleft(), mueller_mirror() * stokes_cpleft());
M
octave-cli -q ask.m 2>ask.err | tee out
cat >expected <<'END'
quarter-wave plate on +45 degrees: Jones left 1 right 0, Mueller left 0 right 1
linear retarder of -90 degrees   : Jones left 0 right 1, Mueller left 1 right 0
mirror on left circular light    : Jones left 1 right 0, Mueller left 0 right 1
END
cmp expected out && echo "octave-optics 0.1.4: seen as described"
