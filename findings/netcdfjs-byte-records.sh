#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# netcdfjs 4.0.0 (npm) misreads variables of 1 or 2 bytes along the unlimited axis of a NetCDF-3 file, without an error: the
# padding of each record to 4 bytes comes back as data. Fails if this changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund netcdfjs@4.0.0 >/dev/null
cat >read.js <<'JS'
const { NetCDFReader } = require('netcdfjs');
const int = (n) => { const b = Buffer.alloc(4); b.writeInt32BE(n); return b; };
const name = (s) => Buffer.concat([int(s.length), Buffer.from(s.padEnd(4 * Math.ceil(s.length / 4), '\0'))]);
// The classic format: magic, records, one axis t without limit, no attributes, variables over t, then the records.
function file(records, variables) {
  const header = (begin) => Buffer.concat([Buffer.from('CDF\x01'), int(records.length), int(10), int(1), name('t'), int(0), int(0), int(0),
    int(11), int(variables.length), ...variables.flatMap((v, i) =>
      [name(v.name), int(1), int(0), int(0), int(0), int(v.type), int(4), int(begin + 4 * i)])]);
  return Buffer.concat([header(header(0).length), ...records]);
}
const byte = { name: 'flag', type: 1 }, number = { name: 'n', type: 4 };
const padded = [7, 8, 9].map((x) => Buffer.concat([Buffer.from([x, 0x81, 0x81, 0x81]), int(100 + x)]));
const reader = new NetCDFReader(file(padded, [byte, number]));
console.log('flag', JSON.stringify(reader.getDataVariable('flag')), 'n', JSON.stringify(reader.getDataVariable('n')));
JS
node read.js | tee out
echo "in the file: flag 7, 8, 9 and n 107, 108, 109"
cat >expected <<'END'
flag [[7,129,129,129],[8,129,129,129],[9,129,129,129]] n [107,108,109]
END
cmp expected out && echo "netcdfjs 4.0.0: seen as described"
