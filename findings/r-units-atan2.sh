#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# units 0.8-1 of R (Debian 12): atan2 of two lengths has the unit of the first: atan2 of 1 m and 1 m is "0.785 m", and of 1 cm
# and 1 m it is the same, as the units are taken off and not converted. No error, no warning; atan of their ratio is
# good. So angles of a goniometer from heights and distances in different units are wrong by far. Fails if this changes.
# Takes R and udunits2 as they are installed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root r-cran-units=0.8-1+dfsg-1 r-cran-rcpp=1.0.10-1
for package in *.deb; do dpkg -x "$package" .; done
cat >ask.R <<'R'
.libPaths(c("usr/lib/R/site-library", .libPaths()))
suppressPackageStartupMessages(library(units))
options(warn = 2)
height <- set_units(1, "cm")
distance <- set_units(1, "m")
show <- function(what, value) cat(what, paste0(format(value, digits = 6), "\n"))
show("atan2(1 m, 1 m):", atan2(distance, distance))
show("atan2(1 cm, 1 m):", atan2(height, distance))
show("atan(1 cm / 1 m):", atan(set_units(height / distance, "1")))
show("1 cm + 1 m, converted:", height + distance)
R
Rscript ask.R | tee out
cat >expected <<'END'
atan2(1 m, 1 m): 0.785398 [m]
atan2(1 cm, 1 m): 0.785398 [cm]
atan(1 cm / 1 m): 0.00999967 [rad]
1 cm + 1 m, converted: 101 [cm]
END
cmp expected out && echo "units 0.8-1: seen as described"
