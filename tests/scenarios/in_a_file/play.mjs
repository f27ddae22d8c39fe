// Plays scripts on benches in files: reads [{code, pack, scripts}] from standard input, writes what each script gave.
import { createRequire } from "node:module";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const web = join(import.meta.dirname, "../../../web");
const { rolldown } = await import(pathToFileURL(createRequire(join(web, "package.json")).resolve("rolldown")));
const folder = mkdtempSync(join(process.env.TMPDIR ?? "/tmp", "play-"));
try {
  const bundle = await rolldown({ input: join(web, "src/in-a-file/play.ts"), logLevel: "silent" });
  await bundle.write({ file: join(folder, "play.mjs"), format: "esm" });
  const { play } = await import(pathToFileURL(join(folder, "play.mjs")));
  const found = [];
  for (const { code, pack, scripts } of JSON.parse(readFileSync(0, "utf8"))) found.push(await play(code, pack, scripts));
  process.stdout.write(JSON.stringify(found));
} finally {
  rmSync(folder, { recursive: true });
}
