import { FileBench } from "./file-bench";
import type { FileCommand, FileDocument } from "./file-document";
import { bytesOf, unpacked } from "./pack";
import { TrackRun } from "./track-run";

/** A command for a tick, or how many ticks the bench runs at most. */
interface Script {
  ticks: number;
  /** Ticks of one call, in turn; as a page would have them. */
  slices: number[];
  commands: [number, FileCommand][];
  /** Signals whose last ticks are wanted, and how many of them. */
  seen?: { signals: number[]; ticks: number };
}

/** Play scripts on the bench of a file without a page: the digest, the last tick, and the log of each. */
export async function play(code: string, pack: string, scripts: Script[]) {
  const bench = await FileBench.load(await bytesOf(code), unpacked<FileDocument>(await bytesOf(pack)));
  const played = [];
  for (const { ticks, slices, commands, seen } of scripts) {
    bench.reset();
    const refused: string[] = [];
    const waiting = [...commands];
    for (let k = 0; ; k += 1) {
      for (; waiting.length > 0 && waiting[0][0] <= bench.tick; waiting.shift()) {
        try {
          bench.apply(waiting[0][1]);
        } catch (error) {
          refused.push(String((error as Error).message));
        }
      }
      const next = Math.min(ticks, waiting[0]?.[0] ?? ticks);
      if (bench.tick >= ticks || bench.advance(Math.min(slices[k % slices.length], next - bench.tick)) === 0) break;
    }
    const { reserved, signals } = bench.document;
    const numbers = bench.arrays.w.view.slice(reserved, reserved + signals.length);
    const bits = Array.from(new BigUint64Array(numbers.buffer), String); // JSON has neither NaN nor -0
    const { tick, trip, log } = bench;
    const cut = seen && bench.cut(seen.signals, tick - seen.ticks, tick, seen.ticks);
    const trace = cut ? Array.from(new Uint32Array(cut.buffer, 0, cut.length)) : [];
    played.push({ digest: await bench.digest(), tick, trip, refused, log, bits, trace });
  }
  return played;
}

export { bytesOf, FileBench, TrackRun, unpacked };
