import { FileBench } from "./file-bench";
import { digestOf } from "./sha";
import { type TrackDocument, writeCase } from "./track-document";

const NO_NUMBER = Number.NaN;

/** The cases of a track, computed one after another. */
export class TrackRun {
  private readonly module: WebAssembly.Module;
  private readonly track: TrackDocument["track"];
  /** The bench of each group, which begins each case anew. */
  private readonly benches = new Map<number, FileBench>();
  private readonly digests: Record<string, string[]>;
  done = 0;

  constructor(module: WebAssembly.Module, track: TrackDocument["track"]) {
    this.module = module;
    this.track = track;
    this.digests = Object.fromEntries(track.rows.map(({ unit }) => [unit, []]));
  }

  /** Compute the next case, and keep the digest of each diagnoser. */
  async next(): Promise<void> {
    const { group, samples } = this.track.cases[this.done];
    const document = writeCase(this.track, this.done);
    const bench = this.benches.get(group) ?? (await FileBench.load(this.module, document));
    this.benches.set(group, bench);
    bench.reset();
    const { said } = this.track.groups[group];
    const columns = Object.values(said).flat();
    const kept = columns.map(() => new Float64Array(samples));
    const signals = bench.arrays.w.view.subarray(document.reserved);
    for (let tick = 0; tick < samples; tick += 1) {
      if (bench.advance(1) === 0) throw new Error(`the board stopped at sample ${tick}: ${bench.trip?.reason}`);
      for (const [i, column] of columns.entries()) {
        const value = signals[column];
        kept[i][tick] = Number.isNaN(value) ? NO_NUMBER : value; // a NaN has many patterns, a digest knows one
      }
    }
    let first = 0;
    for (const [unit, own] of Object.entries(said)) {
      this.digests[unit].push(await digestOf(kept.slice(first, first + own.length)));
      first += own.length;
    }
    this.done += 1;
  }

  /** The digest of the row of a diagnoser, over its digests in all cases so far. */
  digest(unit: string): Promise<string> {
    return digestOf([this.digests[unit].join("")]);
  }
}
