// Bundles the review page into the Python package. `node build.mjs --check` writes nothing and fails where a file differs.
import { readFileSync, writeFileSync, existsSync, readdirSync } from "node:fs";
import { dirname, join, relative, sep } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import { circle, importsOf } from "./circles.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const rooms = join(here, "..", "plugin", "plan_cutters");
/** What is bundled: script and styles of each page, what both pages load before their own script, and where they go. */
const pages = [
  { script: "src/three.ts", global: "THREE", into: join(rooms, "report", "page"), name: "three" },
  { script: "src/main.ts", style: "src/page.css", into: join(rooms, "report", "page"), name: "page" },
  { script: "src/compare.ts", style: "src/compare.css", into: join(rooms, "..", "plan_cutters_ci"), name: "review" },
];
const common = { absWorkingDir: here, minify: true, charset: "ascii", legalComments: "none", write: false };
/** A page takes three.js from the script before its own. */
const before = {
  name: "before",
  setup(build) {
    build.onResolve({ filter: /^\.\/three$/ }, () => ({ path: "three", namespace: "before" }));
    build.onLoad({ filter: /.*/, namespace: "before" }, () => ({ contents: "module.exports = THREE;" }));
  },
};

/** The packages of which something is bundled, each with its version and licence. */
function bundled(inputs) {
  const names = new Set();
  for (const path of Object.keys(inputs)) {
    const parts = path.split("/");
    const at = parts.lastIndexOf("node_modules");
    if (at >= 0) names.add(parts[at + 1].startsWith("@") ? `${parts[at + 1]}/${parts[at + 2]}` : parts[at + 1]);
  }
  return [...names].sort().map((name) => {
    const folder = join(here, "node_modules", ...name.split("/"));
    const { version } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
    const file = readdirSync(folder).find((each) => /^licen[sc]e/i.test(each));
    if (!file) throw new Error(`${name} has no licence file in its package`);
    return { name, version, text: readFileSync(join(folder, file), "utf8").trim().replaceAll("\r", "") };
  });
}

const around = circle(importsOf(join(here, "src")));
if (around.length) throw new Error(`these files import each other in a circle: ${around.join(", ")}`);

const files = new Map();
for (const { script, style, global, into, name } of pages) {
  const target = { bundle: true, format: "iife", target: ["es2022"], metafile: true };
  const whole = global ? { globalName: global } : { plugins: [before] };
  const made = await build({ ...common, ...target, ...whole, entryPoints: [script] });
  const licences = bundled(made.metafile.inputs).map((part) => `${part.name} ${part.version}\n\n${part.text}\n`).join("\n----\n\n");
  // What is written into a page must be plain ASCII, and nothing in it may end the script.
  const plain = licences.replaceAll("©", "(c)").replace(/[^\x00-\x7f]/g, "?");
  const head = plain && `/*! This page contains:\n\n${plain.replaceAll("*/", "* /")}*/\n`;
  const code = `${head}${made.outputFiles[0].text}`;
  for (const word of ["</script", "<!--", "sourceMappingURL"]) {
    if (code.toLowerCase().includes(word.toLowerCase())) throw new Error(`the bundle contains ${word}`);
  }
  files.set(join(into, `${name}.js`), code);
  if (style) files.set(join(into, `${name}.css`), (await build({ ...common, entryPoints: [style], bundle: true })).outputFiles[0].text);
  if (plain) files.set(join(into, "licences.txt"), plain);
}

let stale = 0;
for (const [path, text] of files) {
  const shown = relative(join(here, ".."), path).split(sep).join("/");
  const same = existsSync(path) && readFileSync(path, "utf8") === text;
  if (process.argv.includes("--check")) {
    if (!same) stale += 1;
    console.log(`${same ? "up to date" : "NOT up to date"}  ${shown}`);
  } else {
    writeFileSync(path, text);
    console.log(`${shown}  ${Math.round(text.length / 1024)} KiB`);
  }
}
if (stale) {
  console.error("run `node build.mjs` in page/ and commit what it writes");
  process.exitCode = 1;
}
