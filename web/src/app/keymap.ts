import { may } from "../api/me";
import { actions } from "../bench/actions";
import { makeSlide } from "../bench/change";
import { focusNextGroup } from "../bench/dock";
import { openEditor } from "../bench/edit-unit";
import { lectureRuns } from "../bench/lecture";
import { toggleNarrator } from "../bench/narrator";
import type { PageName } from "../bench/places";
import { askLatest } from "../bench/why";
import { type KeyBinding, keyOf } from "./key-binding";
import { setLayout } from "./layouts";
import { LECTURE_KEYS } from "./lecture/lecture-keys";
import { openPresenter } from "./lecture/presenter";
import { PAGES } from "./pages";
import { togglePresent } from "./present";
import { openSearch } from "./search/search";
import { takeBack } from "./take-back";
import { themeSwitch } from "./theme";

/** The keys of the person at the page; the sheet and the listener read the same list. */
export const keymap = (): KeyBinding[] => {
  const keys = KEYS.filter(({ needs }) => needs.every((right) => may(right)));
  if (!lectureRuns()) return keys;
  const lecture = [...LECTURE_KEYS, NOTES];
  return [...lecture, ...keys.filter(({ key }) => !lecture.some((one) => one.key === key))];
};

const run = keyOf("Run", "drive");
const bench = keyOf("Bench", "drive");
const keep = keyOf("Bench", "drive", "server");
const branch = keyOf("Bench", "branch");
const teach = keyOf("Bench", "teach");
const served = keyOf("Look", "server");
const look = keyOf("Look");

const NOTES = look("i", "I", "notes of the speaker in a window of their own", openPresenter);

const KEYS: KeyBinding[] = [
  run(" ", "Space", "run or pause", actions.toggle),
  run(".", ".", "one tick", actions.stepTick),
  run(",", ",", "one drive period", actions.stepPeriod),
  run("]", "]", "twice as fast", actions.faster),
  run("[", "[", "half as fast", actions.slower),
  run("R", "Shift R", "reset to the start", actions.reset),
  run(">", ">", "skip to the next step of the scenario", actions.skip),
  bench("h", "H", "heal all faults", actions.healAll),
  bench("c", "C", "next controller", actions.nextController),
  keyOf("Bench", "server")("x", "X", "save what happened as a scenario", actions.saveScenario),
  teach("S", "Shift S", "share by a link", actions.share),
  keep("v", "V", "record, and stop", actions.record),
  branch("f", "F", "fork", actions.fork),
  teach("k", "K", "keep this moment", actions.keep),
  teach("o", "O", "write a unit of your own", openEditor),
  keep("n", "N", "new bench", actions.newBench),
  bench("z", "Ctrl Z", "undo", () => takeBack("undo")),
  bench("y", "Ctrl Y", "redo", () => takeBack("redo")),
  bench("Z", "Ctrl Shift Z", "redo", () => takeBack("redo")),
  look("l", "L", "all panels live", actions.live),
  look("1", "1", "lecture layout", () => setLayout("lecture")),
  look("2", "2", "lab layout", () => setLayout("lab")),
  look("3", "3", "research layout", () => setLayout("research")),
  look("s", "S", "slide of before and after the last change", makeSlide),
  served("w", "W", "why the newest verdict", askLatest),
  look("p", "P", "present: panels only, on the whole screen", togglePresent),
  served("q", "Q", "narrator on or quiet", toggleNarrator),
  look("d", "D", "dark or light", () => themeSwitch.flip()),
  look("F6", "F6", "next group of panels", focusNextGroup),
  look("k", "Ctrl K", "search panels, scenarios, equations, devices, settings, places", openSearch),
  look("?", "?", "this sheet", actions.keys),
  ...Object.entries(PAGES).map(([name, { key, title, needs }]) =>
    keyOf("Pages", ...(needs ? [needs] : []))(key, key.toUpperCase(), title, () => actions.page(name as PageName)),
  ),
];

/** Keys that belong to the thing in focus. */
export const LOCAL_KEYS: { shown: string; does: string }[] = [
  { shown: "Delete", does: "on a tab: close the panel" },
  { shown: "Escape, Tab", does: "in the editor of units: leave the text" },
  { shown: "← →", does: "on a scope: move through the past" },
  { shown: "+ −", does: "on a scope: zoom" },
  { shown: "drag, wheel", does: "on a scope: look at the past; double click returns to live" },
];
