import { existsSync, readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { defineConfig, type Plugin } from "vite";

const root = fileURLToPath(new URL("..", import.meta.url));
const target = process.env["CARGO_TARGET_DIR"] ?? `${root}target`;
const compiled = `${target}/wasm32-unknown-unknown/viewer/polhode_wasm.wasm`;

/** The compiled core as a module: compressed, in base64, so that the bundle is one file. */
function core(): Plugin {
  const name = "virtual:polhode-core";
  return {
    name,
    resolveId: (id) => (id === name ? `\0${name}` : undefined),
    load(id) {
      if (id !== `\0${name}`) return undefined;
      if (!existsSync(compiled)) throw new Error(`${compiled} is missing: run make viewer`);
      this.addWatchFile(compiled);
      const packed = gzipSync(readFileSync(compiled), { level: 9 }).toString("base64");
      return `export default ${JSON.stringify(packed)};`;
    },
  };
}

/** Binary files that presets name, in base64. */
function binary(): Plugin {
  return {
    name: "base64",
    enforce: "pre",
    load(id) {
      const [path, query] = id.split("?");
      if (query !== "base64" || path === undefined) return undefined;
      return `export default ${JSON.stringify(readFileSync(path).toString("base64"))};`;
    },
  };
}

/**
 * Pages hold the bundle inside `<script>`, where HTML parses by other rules after `<!--`. These characters occur in
 * literals of texts and patterns only, where `<` can be escaped.
 */
function embeddable(): Plugin {
  return {
    name: "embeddable",
    generateBundle(_, bundle) {
      for (const file of Object.values(bundle)) {
        if (file.type === "chunk") file.code = file.code.replaceAll("<!--", "\\x3C!--");
      }
    },
  };
}

export default defineConfig({
  plugins: [core(), binary(), embeddable()],
  oxc: { jsx: { runtime: "automatic", importSource: "preact" } },
  server: { fs: { allow: [root] } },
  build: {
    outDir: `${root}python/polhode/_viewer`,
    emptyOutDir: false, // the folder holds the Python modules of the viewer,
    target: "es2022",
    lib: { entry: "src/index.ts", formats: ["es"], fileName: () => "viewer.js" },
    // A library is left readable unless this is said.
    rolldownOptions: { output: { minify: true } },
    // The notices that the licences of the libraries in the bundle ask for.
    license: { fileName: "viewer.licenses.md" },
    chunkSizeWarningLimit: 2000,
  },
});
