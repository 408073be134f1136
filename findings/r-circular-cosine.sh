#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# circular 0.4-95 of R (Debian 12): angles carry their units, but cos, sin and tan take the number as radians and call the
# result an angle in degrees: cos of circular(60, units = "degrees") is -0.952. Sums do not convert either: 10 degrees + pi/18
# is 10.17 degrees. No warning; mean and c() do convert. So means of azimuths are right and what is made of them is not.
# Fails if this changes. Takes R as it is installed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq -o APT::Sandbox::User=root r-cran-circular=0.4-95-1 r-cran-boot=1.3-28.1-1 r-cran-mvtnorm=1.1-3-1+b1
for package in *.deb; do dpkg -x "$package" .; done
cat >ask.R <<'R'
.libPaths(c("usr/lib/R/site-library", "usr/lib/R/library", .libPaths()))
suppressPackageStartupMessages(library(circular))
options(warn = 2)
degrees <- function(x) circular(x, units = "degrees")
show <- function(what, x) cat(paste(c(what, format(round(as.numeric(x), 4)), circularp(x)$units), collapse = " "), "\n", sep = "")
show("mean of 50 and 70 degrees:", mean(degrees(c(50, 70))))
show("its cosine, 0.5 is right:", cos(mean(degrees(c(50, 70)))))
show("tan of 45 degrees, 1 is right:", tan(degrees(45)))
show("10 degrees and pi/18 in one vector:", c(degrees(10), circular(pi / 18)))
show("their sum, 20 is right:", degrees(10) + circular(pi / 18))
R
Rscript ask.R | tee out
cat >expected <<'END'
mean of 50 and 70 degrees: 60 degrees
its cosine, 0.5 is right: -0.9524 degrees
tan of 45 degrees, 1 is right: 1.6198 degrees
10 degrees and pi/18 in one vector: 10 10 degrees
their sum, 20 is right: 10.1745 degrees
END
cmp expected out && echo "circular 0.4-95: seen as described"
