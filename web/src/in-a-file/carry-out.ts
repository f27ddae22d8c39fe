import { commandWords } from "./command-words";
import type { FileBoard } from "./file-board";
import type { Dependence, FileCommand } from "./file-document";

export interface Done {
  kind: string;
  text: string;
  old: unknown;
  now: unknown;
}

/** The values before and after a command. */
type Effect = Omit<Done, "text">;

/** Carry out a command at this tick; a command that is not allowed changes nothing. */
export const carryOut = (board: FileBoard, command: FileCommand): Done => ({
  ...effectOf(board, command),
  text: commandWords(command),
});

function effectOf(board: FileBoard, command: FileCommand): Effect {
  if ("fault" in command) return inject(board, command.fault, command.severity, command.variant ?? 0);
  if ("heal" in command) return heal(board, command.heal);
  if ("switch" in command) return switchTo(board, command.switch, command.cold ?? false);
  if ("set" in command) return set(board, command.set);
  return resetTrip(board);
}

function inject(board: FileBoard, name: string, severity: number, variant: number): Effect {
  const fault = board.document.faults[name];
  if (!fault) throw new Error(`${name} is no fault of this file`);
  const before = board.faults.get(name);
  if (before?.severity === severity && before.variant === variant)
    throw new Error(`${name} is already there with this severity: heal it first, or give another severity`);
  const { packed, dependence } = fault.variants[variant];
  const row = board.document.rows[fault.row];
  const numbers = packed.slice();
  follow(numbers, dependence, severity);
  if (fault.start >= 0) numbers[fault.start] = board.tick;
  board.arrays.p.view.set(numbers, row.p[0]);
  board.faults.set(name, { severity, variant, since: board.tick });
  if (severity === 0) rest(board, fault.row);
  else board.running.add(fault.row);
  board.arrays.link(board.running);
  return { kind: "inject", old: before?.severity ?? null, now: severity };
}

function heal(board: FileBoard, which: string[] | "all"): Effect {
  const names = which === "all" ? [...board.faults.keys()] : which;
  const missing = names.find((name) => !board.faults.has(name));
  if (missing !== undefined) throw new Error(`${missing} is not there to heal`);
  for (const name of names) {
    const { row, absent } = board.document.faults[name];
    board.arrays.p.view.set(absent, board.document.rows[row].p[0]);
    board.faults.delete(name);
    rest(board, row);
  }
  board.arrays.link(board.running);
  return { kind: "heal", old: names, now: null };
}

/** Let a row rest: its state is as new, and its signals are 0. */
function rest(board: FileBoard, row: number): void {
  if (!board.running.delete(row)) return;
  const { s, w } = board.document.rows[row];
  restore(board, s);
  for (const place of w) board.arrays.w.view[place] = 0;
}

function switchTo(board: FileBoard, name: string, isCold: boolean): Effect {
  const { slots, writes } = board.document.wirings;
  const slot = slots[name];
  if (slot === undefined) throw new Error(`${name} is no controller of this file`);
  const old = board.driving[slot];
  if (old === name && !isCold) throw new Error(`${name} drives already`);
  const driving = { ...board.driving, [slot]: name };
  const choice = Object.values(driving).join("+");
  if (!(choice in writes.w.numbers)) throw new Error(`this file cannot switch to ${name}`);
  for (const part of ["p", "w"] as const)
    for (const [i, place] of writes[part].places.entries())
      board.arrays[part].view[Number(place)] = writes[part].numbers[choice][i];
  for (const [i, place] of writes.io.places.entries())
    board.arrays.io.view[Number(place)] = writes.io.numbers[choice][i];
  board.driving = driving;
  const row = board.document.rows.find(({ key }) => key === name);
  const state = row?.s ?? [0, 0];
  const hasRunAway = !board.arrays.s.view.subarray(...state).every(Number.isFinite);
  if (hasRunAway) {
    const text = `${name} had run away in shadow, so it starts anew`;
    board.note({ actor: "board", kind: "warning", text, old: null, new: null });
  }
  if (isCold || hasRunAway) restore(board, state);
  return { kind: "switch", old, now: name };
}

function set(board: FileBoard, values: Record<string, number>): Effect {
  for (const [path, value] of Object.entries(values)) {
    const entry = board.document.values[path];
    if (!entry) throw new Error(`${path} is no value of this file`);
    if (value < entry.low || value > entry.high) throw new Error(`${path} must be from ${entry.low} to ${entry.high}`);
    if (entry.dependence.grid && !entry.dependence.grid.includes(value))
      throw new Error(`${path} must be one of ${entry.dependence.grid.join(", ")} in a file`);
  }
  const old = Object.fromEntries(Object.keys(values).map((path) => [path, board.values[path]]));
  for (const [path, value] of Object.entries(values))
    follow(board.arrays.p.view, board.document.values[path].dependence, value);
  board.values = { ...board.values, ...values }; // a checkpoint has the values of before
  return { kind: "set", old, now: values };
}

function resetTrip(board: FileBoard): Effect {
  if (!board.trip) throw new Error("the board has not tripped");
  const { arrays, rows, wirings } = board.document;
  const { s, w } = board.arrays;
  const before = { s: s.view.slice(), w: w.view.slice() };
  const choice = Object.values(board.driving).join("+");
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
  const old = board.trip;
  board.trip = undefined;
  return { kind: "reset_trip", old, now: null };
}

/** Give a state the numbers it begins with. */
function restore(board: FileBoard, [from, to]: [number, number]): void {
  board.arrays.s.view.set(board.document.arrays.s.subarray(from, to), from);
}

/** Write the numbers that follow a value. */
function follow(numbers: Float64Array, { places, factors, grid, numbers: points }: Dependence, value: number): void {
  const at = grid ? grid.indexOf(value) : 0;
  if (at < 0) throw new Error(`${value} is no value of this file; there are ${grid?.join(", ")}`);
  for (const [i, place] of places.entries())
    numbers[Number(place)] = factors ? factors[i] * value : (points?.[at * places.length + i] ?? Number.NaN);
}
