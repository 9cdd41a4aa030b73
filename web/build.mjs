// Bundles src/main.js and src/page.css into one C++ source: node build.mjs OUTPUT.cpp
import { build } from "esbuild";
import { mkdir, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";

const output = process.argv[2];
if (!output) {
  console.error("usage: node build.mjs OUTPUT.cpp");
  process.exit(2);
}
const here = import.meta.dirname ?? dirname(new URL(import.meta.url).pathname);

async function bundled(entry, options) {
  const result = await build({
    entryPoints: [join(here, "src", entry)], bundle: true, minify: true, write: false, charset: "ascii",
    target: "es2022", legalComments: "inline", absWorkingDir: here, logLevel: "warning", ...options,
  });
  return result.outputFiles[0].text;
}

// Compilers bound the length of one literal; adjacent literals are one.
function literal(text) {
  const pieces = [];
  for (let at = 0; at < text.length; at += 12000) pieces.push(`R"__craze__(${text.slice(at, at + 12000)})__craze__"`);
  return pieces.join("\n");
}

const style = await bundled("page.css", {});
const script = await bundled("main.js", { format: "iife", loader: { ".css": "text" } });
const returned = (text) => `{\n    static constexpr std::string_view text{${literal(text)}, ${Buffer.byteLength(text)}};\n    return text;\n}\n`;
await mkdir(dirname(output), { recursive: true });
await writeFile(output, `// Written by web/build.mjs.
#pragma GCC diagnostic ignored "-Woverlength-strings"
#include "craze/report/assets.hpp"

namespace craze::report {

std::string_view page_style()
${returned(style)}
std::string_view page_script()
${returned(script)}
}  // namespace craze::report
`);
