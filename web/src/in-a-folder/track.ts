import type { FileBench, FileCheckpoint } from "../in-a-file/file-bench";
import type { FileEvent } from "../in-a-file/file-document";

const EVERY = 10_000;
/** Marks that are kept; beyond, each second of them goes. */
const MOST = 120;

/** A deed on a bench from outside, at a tick. */
export interface Deed {
  tick: number;
  actor: string;
  event: FileEvent;
}

interface Mark {
  tick: number;
  /** How many deeds were done before it. */
  deeds: number;
  kept: FileCheckpoint;
}

interface Way {
  from: number;
  began: number | undefined;
  isBefore: boolean;
}

/** Let a command take effect at this tick edge, or wait for its moment. */
export function carry(bench: FileBench, event: FileEvent, actor: string): void {
  if (event.tick !== null || event.when) bench.wait({ ...event, actor });
  else bench.apply(event.command, actor);
}

/** The past of a bench as checkpoints and deeds, from which any of its ticks is computed again. */
export class Track {
  private marks: Mark[];
  private deeds: Deed[];
  private every = EVERY;
  private due = 0;

  constructor(marks: Mark[] = [], deeds: Deed[] = []) {
    this.marks = marks;
    this.deeds = deeds;
  }

  /** The first tick that can be computed again. */
  get first(): number {
    return this.marks[0].tick;
  }

  /** Take a checkpoint if one is due. */
  follow(bench: FileBench): void {
    if (this.marks.length === 0 || bench.tick >= this.due) this.mark(bench);
  }

  /** Take a checkpoint. */
  mark(bench: FileBench): void {
    this.marks.push({ tick: bench.tick, deeds: this.deeds.length, kept: bench.checkpoint() });
    this.due = bench.tick - (bench.tick % this.every) + this.every;
    if (this.marks.length <= MOST) return;
    this.marks = this.marks.filter((_, i) => i % 2 === 0);
    this.every *= 2;
  }

  note(deed: Deed): void {
    this.deeds.push(deed);
  }

  hasDeedsSince(tick: number): boolean {
    return (this.deeds.at(-1)?.tick ?? -1) >= tick;
  }

  /** The track of a bench that is at a tick of this past and continues from there. */
  until(bench: FileBench): Track {
    const isBefore = ({ tick }: { tick: number }) => tick < bench.tick;
    const track = new Track(this.marks.filter(isBefore), this.deeds.filter(isBefore));
    track.mark(bench);
    return track;
  }

  /**
   * Take a bench to a tick of this past, by way of a checkpoint at a tick `from` or before; `began`: the first tick of
   * the history that the bench has already. The deeds at the tick itself can be left out.
   */
  replay(bench: FileBench, tick: number, { from, began, isBefore }: Way): void {
    const isEarlier = (one: Mark) => one.tick <= from && !(isBefore && one.tick === tick);
    const mark = this.marks.findLast(isEarlier) ?? this.marks[0];
    bench.restore(mark.kept, began);
    for (const { tick: at, event, actor } of this.deeds.slice(mark.deeds)) {
      if (at > tick || (isBefore && at === tick)) break;
      bench.advance(at - bench.tick);
      carry(bench, event, actor);
    }
    bench.advance(tick - bench.tick);
  }
}
