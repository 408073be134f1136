// SPDX-License-Identifier: BSD-3-Clause
// One file that works from any place, file:// too: scripts, styles and the WebAssembly module are in the page.
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

import { defineConfig } from "vite";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

/** virtual:wasm; and no other way to that file, which would be in the page twice. */
function wasm() {
  return {
    name: "mmbrdf-wasm",
    enforce: "pre",
    resolveId: (id) => (id === "virtual:wasm" ? "\0wasm" : undefined),
    load: (id) =>
      id === "\0wasm"
        ? `export default "${gzipSync(readFileSync(here("../mmbrdf/dist/mmbrdf_module.wasm")), { level: 9 }).toString("base64")}";`
        : undefined,
    transform: (code, id) =>
      id.includes("/mmbrdf/")
        ? code.replace(/new URL\(\s*"[^"]*\.wasm"\s*,\s*import\.meta\.url\s*\)/g, 'new URL("about:blank")')
        : undefined,
  };
}

/** Scripts and styles in the page. */
function oneFile() {
  return {
    name: "mmbrdf-one-file",
    enforce: "post",
    generateBundle(_, bundle) {
      const page = Object.values(bundle).find((one) => one.fileName.endsWith(".html"));
      for (const one of Object.values(bundle)) {
        const tag = (text) => () => text; // no $ of a script means anything
        if (one.type === "chunk") {
          const script = one.code.replaceAll("</script", "<\\/script");
          page.source = page.source
            .replace(new RegExp(`<script[^>]*src="[^"]*${one.fileName}"[^>]*></script>`), "")
            .replace("</body>", tag(`<script type="module">${script}</script></body>`));
        } else if (one.fileName.endsWith(".css")) {
          page.source = page.source.replace(
            new RegExp(`<link[^>]*href="[^"]*${one.fileName}"[^>]*>`),
            tag(`<style>${one.source}</style>`),
          );
        } else continue;
        delete bundle[one.fileName];
      }
    },
  };
}

export default defineConfig({
  root: here("."),
  base: "./",
  plugins: [wasm(), oneFile()],
  worker: { format: "iife", plugins: () => [wasm()] }, // a page of file:// may not start modules
  resolve: { alias: { mmbrdf: here("../mmbrdf/index.js") } },
  build: {
    outDir: here("../dist"),
    emptyOutDir: true,
    target: "es2022",
    modulePreload: false,
    assetsInlineLimit: 1 << 30,
    chunkSizeWarningLimit: 4096,
    rollupOptions: { output: { inlineDynamicImports: true } },
  },
});
