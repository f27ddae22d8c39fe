import type { Score } from "../api/types";
import type { FileBench } from "../in-a-file/file-bench";
import type { FileScore } from "../in-a-file/file-document";

/** The counters of all diagnosers that have judged a sample, as the server describes them. */
export function scoresOf(bench: FileBench): Record<string, Score> {
  const all = Object.entries(bench.document.scores).map(([name, score]) => [name, read(bench, score)] as const);
  return Object.fromEntries(all.filter(([, { samples }]) => samples > 0));
}

function read(bench: FileBench, { row, names, places, kept, winner, unexplained }: FileScore): Score {
  const state = bench.arrays.s.view.subarray(...bench.document.rows[row].s);
  const { view } = bench.arrays.w;
  const one = (name: string) => state[places[name]];
  const list = (name: string, from: number, to: number) => [...state.subarray(places[name] + from, places[name] + to)];
  const last = (name: string) => list(name, kept[name] - exits, kept[name]);
  const exits = Math.min(one("exits"), kept.exit_tick);
  const samples = last("exit_samples");
  const confusion = list("confusion", 0, names.length ** 2);
  return {
    names,
    samples: one("total"),
    winner: view[winner],
    truth: one("started") ? one("truth") : -1,
    correct_fraction: one("right") / Math.max(one("total"), 1),
    false_switches: one("exits"),
    last_false_switches: last("exit_tick").map((tick, i) => ({ tick, samples: samples[i] })),
    delays: list("delays", 0, Math.min(one("steps"), kept.delays)).map((value) => (value < 0 ? null : value)),
    since_tick: one("since"),
    nis: one("nis_sum") ? one("nis_sum") / one("nis_count") : null,
    least_nis: Math.min(...list("average", 0, names.length)),
    unexplained: view[unexplained] !== 0,
    confusion: names.map((_, i) => confusion.slice(i * names.length, (i + 1) * names.length)),
  };
}
