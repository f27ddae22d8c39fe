import { presetLabel } from "../bench/time-scale";
import { formatMoment, formatTick } from "../ui/format";
import { TIME_WINDOWS_MS, windowItems } from "../ui/time-axis";
import { button, element, menu, write } from "./dom";
import type { FileBench } from "./file-bench";
import type { Pace } from "./pace";
import type { TimeWindow } from "./time-window";

const SCALES = [0.0002, 0.002, 0.02, 0.2, 1, null];
const SHOWN_OF_DIGEST = 16;

/** Run, step, start again, the pace, the window, and the digest of the samples so far. */
export class RunBar {
  readonly root = element("div", { className: "bar" });
  private readonly bench: FileBench;
  private readonly pace: Pace;
  private readonly time: TimeWindow;
  private readonly runs: HTMLButtonElement;
  private readonly live: HTMLButtonElement;
  private readonly clock = element("output", { className: "clock" });
  private readonly trip = element("span", { className: "trip" });
  private readonly digest = element("output", { className: "digest" });

  constructor(bench: FileBench, pace: Pace, time: TimeWindow, act: (what: () => void) => void) {
    this.bench = bench;
    this.pace = pace;
    this.time = time;
    this.runs = button("Pause", () => this.toggle(), "main");
    this.live = button("Newest", time.goLive);
    const step = button("Step", () => act(() => this.step()));
    step.title = "A tenth of the window";
    const again = button("Start again", () => act(() => this.restart()));
    const untrip = button("Reset", () => act(() => bench.apply({ reset_trip: true })));
    untrip.title = "All blocks start anew; time and faults continue";
    this.trip.append(element("b"), untrip);
    const scales = SCALES.map((scale) => [String(scale), presetLabel(scale)] as const);
    const paces = menu("Pace", scales, String(pace.scale), (scale) => {
      pace.scale = scale === "null" ? null : Number(scale);
    });
    const windows = windowItems(TIME_WINDOWS_MS.scope, time.windowMs).map(
      ({ value, label }) => [value, label] as const,
    );
    const choice = menu("Window", windows, String(time.windowMs), (ms) => time.choose(Number(ms)));
    const tell = button("Digest", () => void this.tellDigest());
    tell.title = "A hash of every sample so far: the same on the server, on the command line and in this file";
    this.root.append(this.runs, step, again, paces, choice, this.live, this.clock, this.trip, tell, this.digest);
  }

  /** Show the state of now. */
  show(): void {
    const { bench } = this;
    write(this.runs, this.pace.isRunning ? "Pause" : "Run");
    write(this.clock, `${formatMoment(bench.tick * bench.document.dt_ms)}, ${formatTick(bench.tick)}`);
    this.live.hidden = !this.time.isHeld;
    this.trip.hidden = bench.trip === undefined;
    write(this.trip.firstElementChild as HTMLElement, bench.trip ? `Tripped: ${bench.trip.reason}` : "");
  }

  toggle(): void {
    this.pace.isRunning = !this.pace.isRunning;
    this.show();
  }

  private step(): void {
    this.pace.isRunning = false;
    this.bench.advance(Math.max(1, Math.round(this.time.windowMs / this.bench.document.dt_ms / 10)));
  }

  private restart(): void {
    this.bench.reset();
    this.time.goLive();
    write(this.digest, "");
  }

  private async tellDigest(): Promise<void> {
    const { tick } = this.bench;
    const digest = await this.bench.digest();
    this.digest.title = digest;
    write(this.digest, `${formatTick(tick)}: ${digest.slice(0, SHOWN_OF_DIGEST)}…`);
  }
}
