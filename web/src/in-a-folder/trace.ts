import type { components } from "../api/schema";
import type { FileBench } from "../in-a-file/file-bench";

type Schemas = components["schemas"];

/** Least and largest values of signals over a span, in columns, as the server answers it. */
export function traceOf(bench: FileBench, query: URLSearchParams): Schemas["Trace"] {
  const { signals, dt_ms } = bench.document;
  const all = signals.map(({ name }) => name);
  const names = query.getAll("signals");
  const unknown = names.find((name) => !all.includes(name));
  if (unknown !== undefined) throw new Error(`there is no signal ${unknown}`);
  const start_tick = Math.max(Number(query.get("start_tick")), bench.oldest);
  const end_tick = Math.max(start_tick + 1, Math.min(Number(query.get("end_tick")), bench.tick));
  const columns = Math.min(Number(query.get("columns")), end_tick - start_tick);
  const places = names.map((name) => all.indexOf(name));
  const data = bench.cut(places, start_tick, end_tick, columns);
  const half = (i: number) => Array.from(data.subarray(i * columns, (i + 1) * columns), numberOrNull);
  const found = names.map((name, i): [string, Schemas["Extremes"]] => [
    name,
    { min: half(2 * i), max: half(2 * i + 1) },
  ]);
  return { start_tick, end_tick, dt_ms, signals: Object.fromEntries(found) };
}

const numberOrNull = (value: number): number | null => (Number.isFinite(value) ? value : null);
