// Bundles the page into the Python package: one ES module with its licences, and the map next to the sources.
import { build } from "esbuild";
import { readFileSync, renameSync, writeFileSync } from "node:fs";

// three.js without headsets, and shaders without indents: a hundredth of the wheel's limit
const NO_HEADSET = `class WebXRManager extends EventDispatcher {
  constructor() { super(); this.enabled = this.isPresenting = false; this.cameraAutoUpdate = true; }
  setAnimationLoop() {}
  getEnvironmentBlendMode() {}
  dispose() {}
}`;
const smallerThree = {
  name: "smaller-three",
  setup(build) {
    build.onLoad({ filter: /three\.module\.js$/ }, ({ path }) => {
      const source = readFileSync(path, "utf8"), start = source.indexOf("\nclass WebXRManager extends EventDispatcher {") + 1, end = source.indexOf("\n}\n", start) + 2;
      if (!start || end < start) throw new Error("three.module.js holds no WebXRManager; see build.mjs");
      return { contents: (source.slice(0, start) + NO_HEADSET + source.slice(end)).replace(/\\n(\\t)+/g, "\\n"), loader: "js" };
    });
  },
};
const out = "../src/mmweaver/viz/page/mmweaver.js";
await build({
  entryPoints: ["src/main.ts"], outfile: out, bundle: true, plugins: [smallerThree], format: "esm", minify: true, target: "es2022",
  sourcemap: "external", sourcesContent: false, legalComments: "eof", loader: { ".css": "text" },
});
renameSync(`${out}.map`, "mmweaver.js.map");
const licence = readFileSync("node_modules/three/LICENSE", "utf8");
writeFileSync("../src/mmweaver/viz/page/LICENSES.txt", `mmweaver.js contains three.js:\n\n${licence}`);
