import type { BoardDocument } from "./file-document";
import type { Placed, WasmRoom } from "./wasm-room";

/** Most signals and columns of one picture. */
const SIGNALS = 64;
const COLUMNS = 4096;
/** Most conditions that are watched at a time. */
const WATCHES = 256;
const SPARE = 1 << 20;
/** The arrays that the next ticks depend on. */
const NUMBERS = ["p", "s", "w", "io", "folds", "last"] as const;

/** How a signal crosses: for each way the target and the numbers beyond which it has been back. */
export interface Crossing {
  ways: number[][];
  /** Whether the target is outside its numbers. */
  outside: boolean;
  /** 1 where the signal has been back since the last crossing. */
  ready: BigInt64Array;
}

/** The arrays of a bench in the memory of its code, and the kernels over them. */
export class BenchArrays {
  readonly p: Placed<Float64Array>;
  readonly s: Placed<Float64Array>;
  readonly w: Placed<Float64Array>;
  readonly io: Placed<BigInt64Array>;
  readonly folds: Placed<BigUint64Array>;
  /** The numbers that the followed signals had last. */
  readonly last: Placed<Float64Array>;
  private readonly room: WasmRoom;
  private readonly document: BoardDocument;
  private readonly table: Placed<BigInt64Array>;
  private readonly watches: Placed<Float64Array>;
  private readonly followed: Placed<BigInt64Array>;
  private readonly rings: Placed[];
  private readonly resting: Placed<Uint8Array>;
  private readonly groups: Placed<BigInt64Array>;
  private readonly places: Placed<BigInt64Array>;
  private readonly picture: Placed<Float32Array>;
  /** Ways in which a signal crosses, whether it is ready for each, and the crossings that were found. */
  private readonly ways: Placed<Float32Array>;
  private readonly ready: Placed<BigInt64Array>;
  private readonly found: Placed<BigInt64Array>;
  private readonly owners: Placed<BigInt64Array>;
  private readonly words: Placed<BigUint64Array>;
  /** Signals and folds of a board that rests. */
  private readonly rested: Placed<Float64Array>;
  private readonly restedFolds: Placed<BigUint64Array>;
  private rows = 0;

  constructor(room: WasmRoom, document: BoardDocument) {
    const { arrays, followed, history, outputs } = document;
    this.room = room;
    this.document = document;
    this.p = room.put(arrays.p);
    this.s = room.put(arrays.s);
    this.w = room.put(arrays.w);
    this.io = room.put(arrays.io);
    this.folds = room.put(document.folds, [2, outputs]);
    this.last = room.put(followed.last);
    this.table = room.put(arrays.table);
    this.watches = room.place(Float64Array, [WATCHES, 3]);
    this.followed = room.put(followed.columns);
    const rings = [history.ring, history.buckets, history.buckets].map((of) => room.place(Float32Array, of));
    this.rings = [...rings, room.put(history.offsets), room.put(history.sizes)];
    this.resting = room.place(Uint8Array, [history.ring[0]]);
    this.groups = room.place(BigInt64Array, [SIGNALS]);
    this.places = room.place(BigInt64Array, [SIGNALS]);
    this.picture = room.place(Float32Array, [SIGNALS, 2, COLUMNS]);
    this.ways = room.place(Float32Array, [2, 4]);
    this.ready = room.place(BigInt64Array, [2]);
    this.found = room.place(BigInt64Array, [COLUMNS]);
    this.owners = room.place(BigInt64Array, [outputs]);
    this.words = room.place(BigUint64Array, [document.rows.length, 2]);
    this.rested = room.place(Float64Array, [arrays.w.length + 1]);
    this.restedFolds = room.place(BigUint64Array, [2, outputs]);
  }

  /** The bytes of all arrays of a board. */
  static bytes({ arrays, folds, history }: BoardDocument): number {
    const numbers = Object.values(arrays).reduce((sum, one) => sum + one.length, 2 * folds.length + 3 * WATCHES);
    const rings = history.ring[0] * history.ring[1] + 2 * history.buckets[0] * history.buckets[1];
    return 8 * numbers + 4 * (rings + 2 * SIGNALS * COLUMNS) + SPARE;
  }

  /** All arrays as they are before the first tick. */
  reset(): void {
    const { arrays, folds, followed } = this.document;
    this.p.view.set(arrays.p);
    this.s.view.set(arrays.s);
    this.w.view.set(arrays.w);
    this.io.view.set(arrays.io);
    this.folds.view.set(folds);
    this.last.view.set(followed.last);
  }

  /** A copy of the numbers that the next ticks depend on. */
  copy() {
    return NUMBERS.map((name) => this[name].view.slice());
  }

  /** Take over such a copy. */
  paste(copied: ReturnType<BenchArrays["copy"]>): void {
    for (const [i, name] of NUMBERS.entries()) this[name].view.set(copied[i] as never);
  }

  /** Take over the history of another bench of the same document. */
  adopt({ rings }: BenchArrays): void {
    for (const [i, ring] of rings.entries()) if (ring !== this.rings[i]) this.rings[i].view.set(ring.view as never);
  }

  /** Run these rows from now on, in their order. */
  link(running: ReadonlySet<number>): void {
    const { arrays, segments, rows: all } = this.document;
    const columns = arrays.table.length / all.length;
    const rows = [...running].sort((a, b) => a - b);
    this.rows = 0;
    for (let i = 0; i < rows.length; this.rows += 1) {
      const segment = segments.find((one) => one.rows.every((row, k) => row === rows[i + k]));
      const own = arrays.table.slice(columns * rows[i], columns * (rows[i] + 1));
      if (segment) own.set([BigInt(segment.step), 0n, 0n, 0n, 1n]); // all of the board, at each tick
      this.table.view.set(own, columns * this.rows);
      i += segment?.rows.length ?? 1;
    }
    this.table.lengths = [this.rows, columns];
  }

  /** Run up to `n` ticks; how many were run, and why the loop returned. */
  run(n: number, tick: number, watches: readonly number[][]): { ran: number; why: number } {
    const { dt_ms, signals, outputs, trip } = this.document;
    if (this.rows === 0) return { ran: n, why: 0 };
    this.watches.view.set(watches.flat());
    this.watches.lengths = [watches.length, 3];
    const board = [this.table, this.p, this.s, this.w, this.io, signals.length - outputs, this.folds, trip];
    const followed = [this.watches, this.followed, this.last];
    const [ran, why] = this.room.call("run", n, tick, dt_ms, ...board, ...followed, ...this.rings, this.resting);
    return { ran, why };
  }

  /** Let ticks pass in which the board rests: the past has no numbers for them. */
  rest(n: number, tick: number): void {
    if (n === 0) return;
    const { dt_ms, signals, outputs } = this.document;
    const nothing = { ...this.table, lengths: [0, this.table.lengths[1]] };
    const unheard = [
      { ...this.watches, lengths: [0, 3] },
      { ...this.followed, lengths: [0] },
      { ...this.last, lengths: [0] },
    ];
    this.rested.view.fill(Number.NaN);
    this.rested.view[this.w.view.length] = 0; // the place of a trip that never comes
    const board = [nothing, this.p, this.s, this.rested, this.io, signals.length - outputs, this.restedFolds];
    this.room.call("run", n, tick, dt_ms, ...board, this.w.view.length, ...unheard, ...this.rings, this.resting);
  }

  /** Least and largest values of signals in each column: [signal][least, largest][column]. */
  cut(signals: readonly number[], kept: [number, number], span: [number, number], columns: number): Float32Array {
    const { history } = this.document;
    const count = Math.min(columns, COLUMNS);
    for (const [k, signal] of signals.entries()) {
      this.groups.view[k] = history.groups[signal];
      this.places.view[k] = history.places[signal];
    }
    this.groups.lengths = [signals.length];
    this.places.lengths = [signals.length];
    this.picture.lengths = [signals.length, 2, count];
    this.room.call("cut", ...this.rings, this.groups, this.places, ...kept, ...span, this.picture);
    return this.picture.view.slice(0, signals.length * 2 * count);
  }

  /** The ticks of a span at which a signal crosses, at most so many; the crossing keeps whether it has been back. */
  crossings(signal: number, kept: [number, number], [start, stop]: [number, number], crossing: Crossing, most: number) {
    const ticks: number[] = [];
    this.ways.view.set(crossing.ways.flat());
    this.ways.lengths = [crossing.ways.length, 4];
    this.ready.view.set(crossing.ready);
    this.ready.lengths = [crossing.ready.length];
    for (let at = start; at < stop && ticks.length < most; at += COLUMNS) {
      const end = Math.min(at + COLUMNS, stop);
      this.cut([signal], kept, [at, end], end - at);
      const samples = { ...this.picture, lengths: [end - at] }; // a column of one tick: its least value is the sample
      this.found.lengths = [Math.min(COLUMNS, most - ticks.length)];
      const [count] = this.room.call("crossings", samples, this.ways, Number(crossing.outside), this.ready, this.found);
      ticks.push(...Array.from(this.found.view.subarray(0, count), (place) => at + Number(place)));
    }
    crossing.ready = this.ready.view.slice(0, crossing.ready.length);
    return ticks;
  }

  /** The two words of each of these blocks, by which its outputs are known. */
  joined(blocks: readonly string[]): BigUint64Array {
    const { fold } = this.document;
    for (const [column, block] of this.document.blocks.entries())
      this.owners.view[column] = BigInt(blocks.indexOf(block));
    for (const k of blocks.keys()) this.words.view.set(fold, 2 * k);
    this.words.lengths = [blocks.length, 2];
    this.room.call("join", this.folds, this.owners, this.words);
    return this.words.view.slice(0, 2 * blocks.length);
  }
}
