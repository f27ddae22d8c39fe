// Computes the cases of a track as its page does: reads {code, pack}, writes the digest of each row.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const { bytesOf, TrackRun, unpacked } = await import(pathToFileURL(join(process.argv[2], "play.mjs")));
const { code, pack } = JSON.parse(readFileSync(0, "utf8"));
const { track } = unpacked(await bytesOf(pack));
const run = new TrackRun(await WebAssembly.compile(await bytesOf(code)), track);
while (run.done < track.cases.length) await run.next();
const digests = await Promise.all(track.rows.map(async ({ unit }) => [unit, await run.digest(unit)]));
process.stdout.write(JSON.stringify(Object.fromEntries(digests)));
