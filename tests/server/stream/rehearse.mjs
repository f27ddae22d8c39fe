// Plays the lines of a page on the server of a folder: reads {code, pack, answers, lines}, writes what it said to each.
import { createRequire } from "node:module";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const web = join(import.meta.dirname, "../../../web");
const { rolldown } = await import(pathToFileURL(createRequire(join(web, "package.json")).resolve("rolldown")));
const folder = mkdtempSync(join(process.env.TMPDIR ?? "/tmp", "rehearse-"));
try {
  const bundle = await rolldown({ input: join(web, "src/in-a-folder/rehearse.ts"), logLevel: "silent" });
  await bundle.write({ file: join(folder, "rehearse.mjs"), format: "esm" });
  const { rehearse } = await import(pathToFileURL(join(folder, "rehearse.mjs")));
  const { code, pack, answers, lines } = JSON.parse(readFileSync(0, "utf8"));
  process.stdout.write(JSON.stringify(await rehearse(code, pack, answers, lines)));
} finally {
  rmSync(folder, { recursive: true });
}
