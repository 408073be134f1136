#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# mathjs 15.2.0 (npm): pinv and eigs depend on the unit of the matrix, as their limits for what counts as zero are absolute.
# The pseudoinverse P of a measurement matrix W of six analysers that lacks a state is good for numbers near 1; in counts W P W
# is off from W by 14 %, and of 1e-14 it is no inverse at all. Eigenvalues of a symmetric matrix of size 1e-12, as a coherency
# matrix in watts is, have one digit or none. No error; ml-matrix 6.15.1 is good at all sizes. Fails if this changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund mathjs@15.2.0 ml-matrix@6.15.1 >/dev/null
cat >ask.js <<'JS'
const math = require('mathjs');
const { Matrix, pseudoInverse, EVD } = require('ml-matrix');
const analysers = [0, 30, 60, 90, 120, 150].map((degrees) => {
  const twice = degrees * Math.PI / 90;
  return [1, 0.8 * Math.cos(twice), 0.8 * Math.sin(twice), 0.3 * Math.sin(twice)];
});
const symmetric = [[2, 1, 0, 0], [1, 3, 1, 0], [0, 1, 4, 1], [0, 0, 1, 5]];
const times = (m, factor) => m.map((row) => row.map((x) => factor * x));
function off(w, p) {
  const W = new Matrix(w);
  return (Matrix.sub(W.mmul(new Matrix(p)).mmul(W), W).norm() / W.norm()).toFixed(3);
}
for (const size of [1e-14, 1, 4e4, 1e9]) {
  const w = times(analysers, size);
  console.log('W of size', size, 'error of W P W: mathjs', off(w, math.pinv(w)), 'ml-matrix', off(w, pseudoInverse(new Matrix(w))));
}
for (const size of [1, 1e-12, 1e-20]) {
  const m = times(symmetric, size);
  const text = (values) => Array.from(values, (x) => (x / size).toFixed(3)).sort().join(' ');
  console.log('eigenvalues at size', size, 'mathjs', text(math.eigs(m).values));
  console.log('eigenvalues at size', size, 'ml-matrix', text(new EVD(new Matrix(m)).realEigenvalues));
}
JS
node ask.js | tee out
cat >expected <<'END'
W of size 1e-14 error of W P W: mathjs 1.000 ml-matrix 0.000
W of size 1 error of W P W: mathjs 0.000 ml-matrix 0.000
W of size 40000 error of W P W: mathjs 0.141 ml-matrix 0.000
W of size 1000000000 error of W P W: mathjs 0.257 ml-matrix 0.000
eigenvalues at size 1 mathjs 1.255 2.823 4.177 5.745
eigenvalues at size 1 ml-matrix 1.255 2.823 4.177 5.745
eigenvalues at size 1e-12 mathjs 1.286 2.951 4.045 5.719
eigenvalues at size 1e-12 ml-matrix 1.255 2.823 4.177 5.745
eigenvalues at size 1e-20 mathjs 2.000 3.000 4.000 5.000
eigenvalues at size 1e-20 ml-matrix 1.255 2.823 4.177 5.745
END
cmp expected out && echo "mathjs 15.2.0: seen as described"
