#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Octave 7.3.0 (Debian 12): textscan, which is the advised reader of tables of text, sums the digits of a number up in doubles:
# "0.3" is not 0.3, so that find(wavelength == 0.3) is empty; three of four numbers of 17 digits are off by up to several units
# in the last place, and 4.94e-324 is 0. dlmread, load -ascii, sscanf and str2double are exact. Fails if this changes.
# Takes Octave as it is installed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cat >ask.m <<'M'
printf("Octave %s\n", version());
for text = {"0.1", "0.3", "0.7", "1e-300", "4.94e-324"}
  x = str2double(text{1});
  printf("%s: textscan %d sscanf %d str2double %.3g\n", text{1}, textscan(text{1}, "%f"){1} == x, sscanf(text{1}, "%f") == x, x);
end
x = mod((1:2000)' * 0.6180339887498949, 1) .* 10 .^ -mod((1:2000)', 8);
file = fopen("x.csv", "w");
fprintf(file, "%.17g,1\n", x);
fclose(file);
file = fopen("x.csv");
scanned = textscan(file, "%f,%f"){1};
fclose(file);
read = dlmread("x.csv", ",")(:, 1);
printf("of %d numbers of 17 digits exact: textscan %d, dlmread %d, worst of textscan %g units\n", numel(x), sum(scanned == x), ...
       sum(read == x), max(abs(scanned - x) ./ eps(x)));
M
octave-cli -q ask.m 2>ask.err | tee out
cat >expected <<'END'
Octave 7.3.0
0.1: textscan 1 sscanf 1 str2double 0.1
0.3: textscan 0 sscanf 1 str2double 0.3
0.7: textscan 0 sscanf 1 str2double 0.7
1e-300: textscan 0 sscanf 1 str2double 1e-300
4.94e-324: textscan 0 sscanf 1 str2double 4.94e-324
of 2000 numbers of 17 digits exact: textscan 588, dlmread 2000, worst of textscan 6 units
END
cmp expected out && echo "Octave 7.3.0: seen as described"
