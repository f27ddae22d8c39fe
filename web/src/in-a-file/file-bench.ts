import { BenchArrays, type Crossing } from "./bench-arrays";
import { type BoardCheckpoint, FileBoard } from "./file-board";
import type { FileCommand, FileDiagnoser, FileDocument, FileEntry, FileSignal, TwinDocument } from "./file-document";
import { digestOf } from "./sha";
import { WasmRoom } from "./wasm-room";

/** Entries that the log of the bench takes from the log of a twin, with their kinds there. */
const NOTED: Record<string, string> = { recognised: "recognised", tripped: "twin_tripped", warning: "warning" };

/** Where the bench has a signal: the twin, undefined for the main board, and its column there. */
interface Place {
  twin: FileBoard<TwinDocument> | undefined;
  column: number;
}

/** The whole state of a bench at a tick edge, but for its history. */
export interface FileCheckpoint extends BoardCheckpoint {
  twins: Record<string, BoardCheckpoint>;
}

/** A live bench without a server: a board, and its twins, which carry out its commands at the same ticks. */
export class FileBench extends FileBoard<FileDocument> {
  /** The signals of all boards, outputs before taps; a signal of a twin is named `<twin>:<signal>`. */
  readonly signals: FileSignal[];
  /** Every diagnoser; a diagnoser of a twin is named `<twin>:<id>`. */
  readonly diagnosers: Record<string, FileDiagnoser>;
  private readonly twins: Map<string, FileBoard<TwinDocument>>;
  private readonly places: Place[];
  private warned = new Set<string>();

  private constructor(document: FileDocument, room: WasmRoom) {
    super(document, new BenchArrays(room, document));
    const twins = Object.entries(document.twins);
    this.twins = new Map(twins.map(([name, twin]) => [name, new FileBoard(twin, new BenchArrays(room, twin))]));
    const all = ({ signals }: { signals: FileSignal[] }) => signals.map((_, column) => column);
    const boards = [
      { prefix: "", document, twin: undefined, columns: all(document) },
      ...[...this.twins].map(([name, twin]) => {
        return { prefix: `${name}:`, document: twin.document, twin, columns: twin.document.shown };
      }),
    ];
    const joined = [true, false].flatMap((isOutput) =>
      boards.flatMap(({ prefix, document: { signals, outputs }, twin, columns }) =>
        columns
          .filter((column) => column < outputs === isOutput)
          .map((column) => ({
            signal: { ...signals[column], name: prefix + signals[column].name },
            place: { twin, column },
          })),
      ),
    );
    this.signals = joined.map(({ signal }) => signal);
    this.places = joined.map(({ place }) => place);
    this.diagnosers = Object.fromEntries(
      boards.flatMap(({ prefix, document: { diagnosers } }) =>
        Object.entries(diagnosers).map(([name, one]) => [prefix + name, one]),
      ),
    );
    this.reset();
  }

  static async load(code: BufferSource | WebAssembly.Module, document: FileDocument): Promise<FileBench> {
    const boards = [document, ...Object.values(document.twins)];
    const bytes = boards.reduce((sum, board) => sum + BenchArrays.bytes(board), 0);
    return new FileBench(document, await WasmRoom.load(code, bytes));
  }

  /** Go back to tick 0, with the events of the scenario waiting. */
  override reset(): void {
    this.warned = new Set();
    super.reset(this.document.events);
    this.done = [...this.document.done];
    for (const twin of this.twins.values()) twin.reset();
  }

  /** A copy of all that the next ticks of all boards depend on. */
  override checkpoint(): FileCheckpoint {
    const twins = [...this.twins].map(([name, twin]) => [name, twin.checkpoint()]);
    return { ...super.checkpoint(), twins: Object.fromEntries(twins) };
  }

  /** Go to a checkpoint with all boards. */
  override restore({ twins, ...own }: FileCheckpoint, began = own.tick): void {
    super.restore(own, began);
    for (const [name, twin] of this.twins) twin.restore(twins[name], began);
  }

  /** Take over the history of another bench of the same document. */
  adopt(other: FileBench): void {
    this.arrays.adopt(other.arrays);
    for (const [name, twin] of this.twins) {
      const same = other.twins.get(name);
      if (same) twin.arrays.adopt(same.arrays);
    }
  }

  /** Run ticks of all; fewer when the board trips. A twin that trips rests until the board is reset. */
  override advance(n: number): number {
    const first = this.tick;
    const ran = super.advance(n);
    if (ran === 0) return 0;
    const todo = this.done;
    this.done = [];
    for (const [name, twin] of this.twins) {
      for (const [tick, command] of todo) mirror(twin, tick, command);
      const seen = twin.log.at(-1)?.seq ?? 0;
      const own = twin.advance(ran);
      for (const entry of twin.log.filter(({ seq }) => seq > seen)) this.repeat(name, entry);
      twin.arrays.rest(ran - own, first + own);
    }
    return ran;
  }

  override note(entry: Omit<FileEntry, "seq" | "tick">, tick = this.tick): void {
    if (entry.kind === "warning") this.warned.add(entry.text);
    super.note(entry, tick);
  }

  /** Least and largest values of signals of the bench in each column of a span of ticks. */
  override cut(signals: readonly number[], start: number, stop: number, columns: number): Float32Array {
    const cuts = new Map<Place["twin"], number[]>();
    for (const [row, signal] of signals.entries()) {
      const { twin } = this.places[signal];
      cuts.set(twin, [...(cuts.get(twin) ?? []), row]);
    }
    const size = 2 * columns;
    const whole = new Float32Array(signals.length * size);
    for (const [twin, rows] of cuts) {
      const asked = rows.map((row) => this.places[signals[row]].column);
      const cut = (twin ?? this).arrays.cut(asked, [this.oldest, this.tick], [start, stop], columns);
      for (const [k, row] of rows.entries()) whole.set(cut.subarray(size * k, size * (k + 1)), size * row);
    }
    return whole;
  }

  override crossings(signal: number, span: [number, number], crossing: Crossing, most: number): number[] {
    const { twin, column } = this.places[signal];
    return (twin ?? this).arrays.crossings(column, [this.oldest, this.tick], span, crossing, most);
  }

  /** The value of a signal of the bench after the last tick; a twin that rests has none. */
  override latest(signal: number): number {
    const { twin, column } = this.places[signal];
    if (twin === undefined) return super.latest(column);
    return twin.trip ? Number.NaN : twin.latest(column);
  }

  /** The SHA-256 over the digests of all boards. */
  override async digest(): Promise<string> {
    if (this.twins.size === 0) return super.digest();
    const digests = [super.digest(), ...[...this.twins.values()].map((twin) => twin.digest())];
    return digestOf([(await Promise.all(digests)).join("")]);
  }

  /** Note a finding of a twin, a warning that the board has not given, and the reason why it rests. */
  private repeat(name: string, { kind, text, tick, old, new: now }: FileEntry): void {
    if (!(kind in NOTED) || (kind === "warning" && this.warned.has(text))) return;
    this.note({ actor: "board", kind: NOTED[kind], text: `${name}: ${text}`, old, new: now }, tick);
  }
}

/** Let a twin carry out a command of the board at the same tick, except for values and controllers of its own. */
function mirror(twin: FileBoard<TwinDocument>, tick: number, command: FileCommand): void {
  const { own_switches: ownSwitches, own_values: ownValues } = twin.document;
  if ("switch" in command && ownSwitches.includes(command.switch)) return;
  if ("set" in command) {
    const shared = Object.entries(command.set).filter(([path]) => !ownValues.includes(path));
    if (shared.length > 0) twin.await(tick, { set: Object.fromEntries(shared) });
    return;
  }
  if ("reset_trip" in command) {
    twin.applyDue(); // what made it safe may wait for this very tick
    if (twin.trip) twin.tick = tick; // it rested meanwhile
  }
  twin.await(tick, command);
}
