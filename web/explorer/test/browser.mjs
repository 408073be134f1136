// SPDX-License-Identifier: BSD-3-Clause
// The page in Debian's Chromium, from its file, as somebody without a server opens it.
import { existsSync } from "node:fs";

import { chromium } from "playwright-core";

export const page_file = new URL("../../dist/index.html", import.meta.url);
const executablePath = process.env.MMBRDF_BROWSER ?? "/usr/bin/chromium";
export const skip = !existsSync(page_file)
  ? "web/dist is not built"
  : !existsSync(executablePath)
    ? `no browser at ${executablePath} (MMBRDF_BROWSER)`
    : false;

export async function browser() {
  return chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-dev-shm-usage"] });
}

/** A page, what it asked of a network, and what it complained of. */
export async function opened(from, { hash = "", viewport = { width: 1280, height: 900 }, colorScheme = "light" } = {}) {
  const context = await from.newContext({ viewport, colorScheme, acceptDownloads: true });
  const page = await context.newPage();
  const requests = [];
  const complaints = [];
  page.on("request", (request) => requests.push(request.url()));
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(error.message));
  await page.goto(page_file.href + hash, { timeout: 120000 });
  await page.waitForSelector("body[data-ready]");
  return { page, requests, complaints };
}

/** When uncertainties are there, too; long enough for a machine that does much else. */
export async function answered(page) {
  await page.waitForFunction(() => document.body.dataset.ready && !document.body.dataset.busy, null, { timeout: 240000 });
}
