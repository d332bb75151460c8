// Bundles the page into the Python package: one ES module with its licences, and the map next to the sources.
import { build } from "esbuild";
import { readFileSync, renameSync, writeFileSync } from "node:fs";

const out = "../src/mmweaver/playback/page/mmweaver.js";
await build({
  entryPoints: ["src/main.ts"], outfile: out, bundle: true, format: "esm", minify: true, target: "es2022",
  sourcemap: "external", sourcesContent: false, legalComments: "eof", loader: { ".css": "text" },
});
renameSync(`${out}.map`, "mmweaver.js.map");
const licence = readFileSync("node_modules/three/LICENSE", "utf8");
writeFileSync("../src/mmweaver/playback/page/LICENSES.txt", `mmweaver.js contains three.js:\n\n${licence}`);
