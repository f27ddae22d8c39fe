import "../ui/theme.css";
import "./in-a-file.css";
import { presetsOn } from "../panels/scope/scope-presets";
import { hover } from "../ui/hover";
import type { Scheme } from "../ui/palette";
import { teachWords } from "./bench-words";
import { ControllerChoice } from "./controller-choice";
import { Course, courseAround } from "./course";
import { DevicePicture } from "./device-picture";
import { element } from "./dom";
import { EventList } from "./event-list";
import { FaultList } from "./fault-list";
import { FileBench } from "./file-bench";
import type { FileDocument, FileSheet } from "./file-document";
import { LanesView } from "./lanes-view";
import { Pace } from "./pace";
import { bytesOf, unpacked } from "./pack";
import { PublishedRun } from "./published-run";
import { QuestionList } from "./question-list";
import { RunBar } from "./run-bar";
import { followScheme } from "./scheme";
import { ScopeView } from "./scope-view";
import { TimeWindow } from "./time-window";
import type { TrackDocument } from "./track-document";
import { TrackView } from "./track-view";
import { ValueList } from "./value-list";

/** As the page: device time per wall time at first, slower than any eye would need without a pause. */
const USUAL_SCALE = 0.002;
const USUAL_TICKS = 2000;
const WORDS_MS = 200;
const NOTICE_MS = 6000;
/** End of the address of a page in a slide: without bars, and paused at first. */
const FRAMED = "#frame";

const textOf = (id: string) => document.getElementById(id)?.textContent ?? "";

async function show(): Promise<void> {
  const code = await bytesOf(textOf("code"));
  const pack = unpacked<FileDocument | TrackDocument>(await bytesOf(textOf("pack")));
  if ("track" in pack) await showTrack(code, pack);
  else showBench(await FileBench.load(code, pack));
}

/** The cases of a track of the benchmark. */
async function showTrack(code: BufferSource, track: TrackDocument): Promise<void> {
  const view = new TrackView(await WebAssembly.compile(code), track);
  document.body.replaceChildren(view.root);
  followScheme();
  await view.estimate();
}

function showBench(bench: FileBench): void {
  const { title, summary, absent, dt_ms: dtMs, version, index, sheet } = bench.document;
  const { diagnosers } = bench;
  teachWords(bench);
  const pace = new Pace(dtMs, USUAL_SCALE);
  const isFramed = location.hash === FRAMED;
  pace.isRunning = !isFramed;
  document.body.classList.toggle("framed", isFramed);
  const time = new TimeWindow(bench, windowOf(dtMs));
  const notice = element("p", { className: "notice", role: "alert" });
  let isDirty = true;
  let noticed: ReturnType<typeof setTimeout> | undefined;
  const act = (what: () => void) => {
    try {
      if (published?.isComputing) throw new Error("The published run is being computed: wait, or stop it");
      what();
      notice.textContent = "";
    } catch (error) {
      notice.textContent = (error as Error).message;
      clearTimeout(noticed);
      noticed = setTimeout(() => notice.replaceChildren(), NOTICE_MS);
    }
    isDirty = true;
    tellAll();
  };
  const published = bench.document.published && new PublishedRun(bench, bench.document.published);
  const bar = new RunBar(bench, pace, time, act);
  const scopes = scopesOf(bench.signals).map((title) => new ScopeView(bench, time, title));
  const scored = Object.keys(diagnosers).filter((id) => diagnosers[id].scored);
  const lanes = scored.length > 0 ? new LanesView(bench, time, scored) : undefined;
  const controllers = new ControllerChoice(bench, act);
  const faults = new FaultList(bench, act);
  const values = new ValueList(bench, act);
  const events = new EventList(bench);
  const device = new DevicePicture(bench);
  const tellAll = () => {
    for (const part of [bar, device, controllers, faults, values, events]) part.show();
  };
  const up = index ? element("a", { href: index }, "All exhibits") : "";
  const head = element("header", {}, up, element("h1", {}, title), element("p", { className: "note" }, summary));
  const foot = element("footer", { className: "remark" }, `Computed in this page by CombBench ${version}. ${absent}`);
  const plots = element("div", { className: "plots" }, ...scopes.map(({ root }) => root), lanes?.root ?? "");
  const course = enterCourse(sheet);
  const questions = sheet && new QuestionList(sheet, (percent, isDone) => course?.score(percent, isDone));
  const lists = [questions, device, published, controllers, faults, values, events];
  const aside = element("aside", {}, ...lists.flatMap((list) => list?.root ?? []));
  document.body.replaceChildren(element("main", {}, head, bar.root, notice, plots, aside, foot));

  let scheme: Scheme = "dark";
  followScheme((now) => {
    scheme = now;
    for (const scope of scopes) scope.dress(scheme);
    isDirty = true;
  });
  time.listen(() => {
    isDirty = true;
  });
  hover.listen(() => {
    isDirty = true;
  });
  new ResizeObserver(() => {
    isDirty = true;
  }).observe(plots);
  document.addEventListener("keydown", (event) => {
    if (event.key !== " " || event.target instanceof HTMLButtonElement || event.target instanceof HTMLSelectElement)
      return;
    event.preventDefault();
    bar.toggle();
  });

  let told = Number.NEGATIVE_INFINITY;
  const draw = (now: number) => {
    const before = bench.tick;
    if (!published?.isComputing) pace.run(now, (n) => bench.advance(n));
    const tells = now - told > WORDS_MS;
    if (bench.tick !== before || isDirty) {
      for (const scope of scopes) scope.draw(tells);
      lanes?.draw(scheme);
      device.draw();
      isDirty = false;
    }
    if (tells) {
      told = now;
      tellAll();
    }
    requestAnimationFrame(draw);
  };
  tellAll();
  requestAnimationFrame(draw);
}

/** The course around the page, if there is one, until the page is left. */
function enterCourse(sheet: FileSheet | undefined): Course | undefined {
  const api = courseAround(window as never);
  const course = api && new Course(api, sheet !== undefined);
  window.addEventListener("pagehide", () => course?.leave());
  return course;
}

/** The presets of the two scopes: displacement and voltage, with twins if there are any; else the first presets. */
function scopesOf(signals: FileBench["signals"]): string[] {
  const titles = presetsOn(signals).map(({ title }) => title);
  const usual = ["Displacement", "Voltage"].flatMap(
    (name) => titles.find((title) => title === `${name} with twins`) ?? titles.find((title) => title === name) ?? [],
  );
  return [...new Set([...usual, ...titles])].slice(0, 2);
}

/** The first window of the menu that holds the usual number of ticks. */
const windowOf = (dtMs: number): number => [4, 10, 20, 50, 100, 200].find((ms) => ms >= USUAL_TICKS * dtMs) ?? 500;

show().catch((error: Error) => {
  document.body.replaceChildren(
    element("p", { className: "failed" }, `This browser cannot show the bench: ${error.message}`),
  );
});
