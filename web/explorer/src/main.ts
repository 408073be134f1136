// SPDX-License-Identifier: BSD-3-Clause
import wasmText from "virtual:wasm";

import load from "mmbrdf";

import { Page } from "./page";
import "./style.css";

async function bytesOf(text: string): Promise<Uint8Array> {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

const wasm = await bytesOf(wasmText);
new Page(await load({ wasm }), wasm);
document.body.dataset.ready = "true";
