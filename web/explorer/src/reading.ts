// SPDX-License-Identifier: BSD-3-Clause
// Tables of samples that take a while to read: the page goes on between parts, says how far it is, and can be told to stop.
import type { SampleReader, Samples } from "mmbrdf";

import { element } from "./dom";

/** Of a file: it is copied three times into memory, of which there are 2 GB. */
export const mostBytes = 500e6;

export const tooLarge = ({ name, size }: File) =>
  `${name}: ${Math.round(size / 1e6)} MB: the page reads up to ${mostBytes / 1e6} MB; the program takes larger tables (mmbrdf inspect, fit, compare).`;

const part = 25; // ms: a drag still follows
const hiddenPart = 500; // nobody drags, and browsers wake a page that is not seen once a second
const rows = 100; // of a part at least

/** Throws what the reader says, and what it was stopped at; frees it. */
export async function readInParts(reader: SampleReader, name: string): Promise<Samples> {
  const stop = element<HTMLButtonElement>("stop-reading");
  let stopped = false;
  stop.onclick = () => (stopped = true);
  try {
    while (!stopped && readPart(reader)) {
      stop.hidden = false;
      const words = `Reading ${name}: ${10 * Math.floor(10 * reader.share)} % …`;
      if (element("reading").textContent !== words) element("reading").textContent = words; // a screen reader says each change
      await new Promise((done) => setTimeout(done));
    }
    if (stopped) throw new Error(`${name}: stopped at sample ${reader.count}: none of them is shown.`);
    return reader.samples();
  } finally {
    stop.hidden = true;
    reader.free();
  }
}

/** Whether there is more. */
function readPart(reader: SampleReader): boolean {
  const until = performance.now() + (document.hidden ? hiddenPart : part);
  while (reader.read(rows)) if (performance.now() > until) return true;
  return false;
}
