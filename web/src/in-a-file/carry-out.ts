import type { FileBench } from "./file-bench";
import type { Dependence, FileCommand } from "./file-document";

interface Done {
  kind: string;
  text: string;
  old: unknown;
  now: unknown;
}

/** Carry out a command at this tick; a command that is not allowed changes nothing. */
export function carryOut(bench: FileBench, command: FileCommand): Done {
  if ("fault" in command) return inject(bench, command.fault, command.severity, command.variant ?? 0);
  if ("heal" in command) return heal(bench, command.heal);
  if ("switch" in command) return switchTo(bench, command.switch, command.cold ?? false);
  if ("set" in command) return set(bench, command.set);
  return resetTrip(bench);
}

function inject(bench: FileBench, name: string, severity: number, variant: number): Done {
  const fault = bench.document.faults[name];
  if (!fault) throw new Error(`${name} is no fault of this file`);
  const before = bench.faults.get(name);
  if (before?.severity === severity && before.variant === variant)
    throw new Error(`${name} is already there with this severity: heal it first, or give another severity`);
  const { packed, dependence } = fault.variants[variant];
  const row = bench.document.rows[fault.row];
  const numbers = packed.slice();
  follow(numbers, dependence, severity);
  if (fault.start >= 0) numbers[fault.start] = bench.tick;
  bench.arrays.p.view.set(numbers, row.p[0]);
  bench.faults.set(name, { severity, variant, since: bench.tick });
  if (severity === 0) rest(bench, fault.row);
  else bench.running.add(fault.row);
  bench.arrays.link(bench.running);
  const sign = severity < 0 ? "" : "+";
  return { kind: "inject", text: `inject ${name} ${sign}${severity}`, old: before?.severity ?? null, now: severity };
}

function heal(bench: FileBench, which: string[] | "all"): Done {
  const names = which === "all" ? [...bench.faults.keys()] : which;
  const missing = names.find((name) => !bench.faults.has(name));
  if (missing !== undefined) throw new Error(`${missing} is not there to heal`);
  for (const name of names) {
    const { row, absent } = bench.document.faults[name];
    bench.arrays.p.view.set(absent, bench.document.rows[row].p[0]);
    bench.faults.delete(name);
    rest(bench, row);
  }
  bench.arrays.link(bench.running);
  return { kind: "heal", text: `heal ${which === "all" ? "all" : names.join(", ")}`, old: names, now: null };
}

/** Let a row rest: its state is as new, and its signals are 0. */
function rest(bench: FileBench, row: number): void {
  if (!bench.running.delete(row)) return;
  const { s, w } = bench.document.rows[row];
  restore(bench, s);
  for (const place of w) bench.arrays.w.view[place] = 0;
}

function switchTo(bench: FileBench, name: string, isCold: boolean): Done {
  const { slots, writes } = bench.document.wirings;
  const slot = slots[name];
  if (slot === undefined) throw new Error(`${name} is no controller of this file`);
  const old = bench.driving[slot];
  if (old === name && !isCold) throw new Error(`${name} drives already`);
  const driving = { ...bench.driving, [slot]: name };
  const choice = Object.values(driving).join("+");
  if (!(choice in writes.w.numbers)) throw new Error(`this file cannot switch to ${name}`);
  for (const part of ["p", "w"] as const)
    for (const [i, place] of writes[part].places.entries())
      bench.arrays[part].view[Number(place)] = writes[part].numbers[choice][i];
  for (const [i, place] of writes.io.places.entries())
    bench.arrays.io.view[Number(place)] = writes.io.numbers[choice][i];
  bench.driving = driving;
  const row = bench.document.rows.find(({ key }) => key === name);
  const state = row?.s ?? [0, 0];
  const hasRunAway = !bench.arrays.s.view.subarray(...state).every(Number.isFinite);
  if (hasRunAway) {
    const text = `${name} had run away in shadow, so it starts anew`;
    bench.note({ actor: "board", kind: "warning", text, old: null, new: null });
  }
  if (isCold || hasRunAway) restore(bench, state);
  return { kind: "switch", text: `switch to ${name}${isCold ? " from a cold start" : ""}`, old, now: name };
}

function set(bench: FileBench, values: Record<string, number>): Done {
  for (const [path, value] of Object.entries(values)) {
    const entry = bench.document.values[path];
    if (!entry) throw new Error(`${path} is no value of this file`);
    if (value < entry.low || value > entry.high) throw new Error(`${path} must be from ${entry.low} to ${entry.high}`);
    if (entry.dependence.grid && !entry.dependence.grid.includes(value))
      throw new Error(`${path} must be one of ${entry.dependence.grid.join(", ")} in a file`);
  }
  const old = Object.fromEntries(Object.keys(values).map((path) => [path, bench.values[path]]));
  for (const [path, value] of Object.entries(values)) {
    follow(bench.arrays.p.view, bench.document.values[path].dependence, value);
    bench.values[path] = value;
  }
  const words = Object.entries(values).map(([path, value]) => `${path} = ${value}`);
  return { kind: "set", text: `set ${words.join(", ")}`, old, now: values };
}

function resetTrip(bench: FileBench): Done {
  if (!bench.trip) throw new Error("the board has not tripped");
  const { arrays, rows, wirings } = bench.document;
  const { s, w } = bench.arrays;
  const before = { s: s.view.slice(), w: w.view.slice() };
  const choice = Object.values(bench.driving).join("+");
  s.view.set(arrays.s);
  w.view.set(arrays.w);
  for (const [i, place] of wirings.writes.w.places.entries())
    w.view[Number(place)] = wirings.writes.w.numbers[choice][i];
  for (const row of rows) {
    const state = before.s.subarray(...row.s);
    if (!row.key.endsWith(".score") || !state.every(Number.isFinite)) continue;
    s.view.set(state, row.s[0]);
    for (const place of row.w) w.view[place] = before.w[place];
  }
  const old = bench.trip;
  bench.trip = undefined;
  return { kind: "reset_trip", text: "reset after the trip", old, now: null };
}

/** Give a state the numbers it begins with. */
function restore(bench: FileBench, [from, to]: [number, number]): void {
  bench.arrays.s.view.set(bench.document.arrays.s.subarray(from, to), from);
}

/** Write the numbers that follow a value. */
function follow(numbers: Float64Array, { places, factors, grid, numbers: points }: Dependence, value: number): void {
  const at = grid ? grid.indexOf(value) : 0;
  if (at < 0) throw new Error(`${value} is no value of this file; there are ${grid?.join(", ")}`);
  for (const [i, place] of places.entries())
    numbers[Number(place)] = factors ? factors[i] * value : (points?.[at * places.length + i] ?? Number.NaN);
}
