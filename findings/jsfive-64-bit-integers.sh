#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# jsfive 0.4.2 (npm) reads 64-bit integers of HDF5 files as numbers of 53 bits, rounded, without a word; h5wasm 0.10.3 reads
# the same file exactly, as BigInt. Identifiers and times in nanoseconds suffer. Fails if this changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund jsfive@0.4.2 h5wasm@0.10.3 >/dev/null
cat >read.mjs <<'JS'
import fs from 'fs';
import * as jsfive from 'jsfive';
import h5wasm from 'h5wasm/node';
await h5wasm.ready;
const made = new h5wasm.File('n.h5', 'w');
made.create_dataset({ name: 'n', data: BigInt64Array.from([9007199254740993n, 1764460800123456789n]) });
made.close();
const bytes = fs.readFileSync('n.h5');
const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
console.log('h5wasm', Array.from(new h5wasm.File('n.h5', 'r').get('n').value, String).join(' '));
console.log('jsfive', Array.from(new jsfive.File(buffer, 'n.h5').get('n').value, (x) => BigInt(x).toString()).join(' '));
JS
node read.mjs | tee out
cat >expected <<'END'
h5wasm 9007199254740993 1764460800123456789
jsfive 9007199254740992 1764460800123456768
END
cmp expected out && echo "jsfive 0.4.2: seen as described"
