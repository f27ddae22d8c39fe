// Plays scripts on benches in files: reads [{code, pack, scripts}] from standard input, writes what each script gave.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const { play } = await import(pathToFileURL(join(process.argv[2], "play.mjs")));
const found = [];
for (const { code, pack, scripts } of JSON.parse(readFileSync(0, "utf8"))) found.push(await play(code, pack, scripts));
process.stdout.write(JSON.stringify(found));
