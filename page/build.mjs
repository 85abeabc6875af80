// Builds the page into service/page: one script, one style sheet, one document, one icon.
// `node build.mjs --check` compares what is there with a new build and changes nothing.
import { build } from "esbuild";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { gzipSync } from "node:zlib";

const here = new URL(".", import.meta.url);
const target = new URL("../service/page/", here);

const built = await build({
  entryPoints: { page: new URL("src/main.tsx", here).pathname },
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  jsx: "automatic",
  jsxImportSource: "preact",
  legalComments: "none",
  write: false,
  outdir: "out",
  logLevel: "warning",
});

const files = new Map();
for (const file of built.outputFiles) {
  files.set(file.path.endsWith(".css") ? "page.css" : "page.js", Buffer.from(file.contents));
}
for (const name of ["index.html", "favicon.svg"]) {
  files.set(name, await readFile(new URL(`src/${name}`, here)));
}

let zipped = 0;
const differing = [];
await mkdir(target, { recursive: true });
for (const [name, content] of files) {
  zipped += gzipSync(content, { level: 9 }).length;
  const file = new URL(name, target);
  const before = await readFile(file).catch(() => Buffer.alloc(0));
  if (before.equals(content)) continue;
  differing.push(name);
  if (!process.argv.includes("--check")) await writeFile(file, content);
}
console.log(`${(zipped / 1000).toFixed(0)} kB gzipped: ${[...files.keys()].join(", ")}`);
if (differing.length && process.argv.includes("--check")) {
  console.error(`service/page differs from its source in: ${differing.join(", ")}. Run: make page`);
  process.exit(1);
}
