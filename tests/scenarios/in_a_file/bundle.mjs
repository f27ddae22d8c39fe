// Writes play.mjs, the bench of a file without a page, into a folder: as a module for Node and for browsers.
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const web = join(import.meta.dirname, "../../../web");
const { rolldown } = await import(pathToFileURL(createRequire(join(web, "package.json")).resolve("rolldown")));
const bundle = await rolldown({ input: join(web, "src/in-a-file/play.ts"), logLevel: "silent" });
await bundle.write({ file: join(process.argv[2], "play.mjs"), format: "esm" });
