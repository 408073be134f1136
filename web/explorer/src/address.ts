// SPDX-License-Identifier: BSD-3-Clause
// The link in the address bar. Browsers take few changes of it, and refuse or drop more: Safari beyond 100 in 30 s, Chromium
// beyond 200 in 10 s, which is three seconds of a drag.

const pause = 350; // ms

export class Address {
  #link = "";
  #last = -Infinity; // time of the last change
  #timer?: ReturnType<typeof setTimeout>;

  /** `written`: told when there is nothing left to change. */
  constructor(readonly written: () => void) {}

  /** Whether the address bar has still to get the last link. */
  get waits(): boolean {
    return this.#timer !== undefined;
  }

  /** At once after a pause, or else when it has passed. */
  show(link: string) {
    this.#link = link;
    if (!this.waits) this.#timer = setTimeout(() => this.#write(), Math.max(0, this.#last + pause - performance.now()));
  }

  #write() {
    this.#timer = undefined;
    this.#last = performance.now();
    history.replaceState(null, "", this.#link);
    this.written();
  }
}
