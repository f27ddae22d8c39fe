import { may, type Right } from "../api/me";
import { actions } from "../bench/actions";
import { makeSlide } from "../bench/change";
import { focusNextGroup } from "../bench/dock";
import { openEditor } from "../bench/edit-unit";
import { lectureRuns } from "../bench/lecture";
import { toggleNarrator } from "../bench/narrator";
import type { PageName } from "../bench/places";
import { askLatest } from "../bench/why";
import { setLayout } from "./layouts";
import { LECTURE_KEYS } from "./lecture/lecture-keys";
import { openPresenter } from "./lecture/presenter";
import { PAGES } from "./pages";
import { togglePresent } from "./present";
import { openSearch } from "./search/search";
import { takeBack } from "./take-back";
import { themeSwitch } from "./theme";

export interface KeyBinding {
  /** `KeyboardEvent.key`, as typed. */
  key: string;
  shown: string;
  /** With Ctrl, or Command where there is one. */
  withControl?: boolean;
  does: string;
  group: "Run" | "Look" | "Bench" | "Pages";
  /** The right that the key needs. */
  needs?: Right;
  run(): void;
}

/** The keys of the person at the page; the sheet and the listener read the same list. */
export const keymap = (): KeyBinding[] => {
  const keys = KEYS.filter(({ needs }) => !needs || may(needs));
  if (!lectureRuns()) return keys;
  const lecture = [...LECTURE_KEYS, NOTES];
  return [...lecture, ...keys.filter(({ key }) => !lecture.some((one) => one.key === key))];
};

const NOTES: KeyBinding = {
  key: "i",
  shown: "I",
  does: "notes of the speaker in a window of their own",
  group: "Look",
  run: openPresenter,
};

const KEYS: KeyBinding[] = [
  { key: " ", shown: "Space", does: "run or pause", group: "Run", needs: "drive", run: actions.toggle },
  { key: ".", shown: ".", does: "one tick", group: "Run", needs: "drive", run: actions.stepTick },
  { key: ",", shown: ",", does: "one drive period", group: "Run", needs: "drive", run: actions.stepPeriod },
  { key: "]", shown: "]", does: "twice as fast", group: "Run", needs: "drive", run: actions.faster },
  { key: "[", shown: "[", does: "half as fast", group: "Run", needs: "drive", run: actions.slower },
  { key: "R", shown: "Shift R", does: "reset to the start", group: "Run", needs: "drive", run: actions.reset },
  {
    key: ">",
    shown: ">",
    does: "skip to the next step of the scenario",
    group: "Run",
    needs: "drive",
    run: actions.skip,
  },
  { key: "h", shown: "H", does: "heal all faults", group: "Bench", needs: "drive", run: actions.healAll },
  { key: "c", shown: "C", does: "next controller", group: "Bench", needs: "drive", run: actions.nextController },
  { key: "x", shown: "X", does: "save what happened as a scenario", group: "Bench", run: actions.saveScenario },
  { key: "S", shown: "Shift S", does: "share by a link", group: "Bench", needs: "teach", run: actions.share },
  { key: "v", shown: "V", does: "record, and stop", group: "Bench", needs: "drive", run: actions.record },
  { key: "f", shown: "F", does: "fork", group: "Bench", needs: "teach", run: actions.fork },
  { key: "k", shown: "K", does: "keep this moment", group: "Bench", needs: "teach", run: actions.keep },
  { key: "o", shown: "O", does: "write a unit of your own", group: "Bench", needs: "teach", run: openEditor },
  { key: "n", shown: "N", does: "new bench", group: "Bench", needs: "drive", run: actions.newBench },
  {
    key: "z",
    shown: "Ctrl Z",
    withControl: true,
    does: "undo",
    group: "Bench",
    needs: "drive",
    run: () => takeBack("undo"),
  },
  {
    key: "y",
    shown: "Ctrl Y",
    withControl: true,
    does: "redo",
    group: "Bench",
    needs: "drive",
    run: () => takeBack("redo"),
  },
  {
    key: "Z",
    shown: "Ctrl Shift Z",
    withControl: true,
    does: "redo",
    group: "Bench",
    needs: "drive",
    run: () => takeBack("redo"),
  },
  { key: "l", shown: "L", does: "all panels live", group: "Look", run: actions.live },
  { key: "1", shown: "1", does: "lecture layout", group: "Look", run: () => setLayout("lecture") },
  { key: "2", shown: "2", does: "lab layout", group: "Look", run: () => setLayout("lab") },
  { key: "3", shown: "3", does: "research layout", group: "Look", run: () => setLayout("research") },
  { key: "s", shown: "S", does: "slide of before and after the last change", group: "Look", run: makeSlide },
  { key: "w", shown: "W", does: "why the newest verdict", group: "Look", run: askLatest },
  { key: "p", shown: "P", does: "present: panels only, on the whole screen", group: "Look", run: togglePresent },
  { key: "q", shown: "Q", does: "narrator on or quiet", group: "Look", run: toggleNarrator },
  { key: "d", shown: "D", does: "dark or light", group: "Look", run: () => themeSwitch.flip() },
  { key: "F6", shown: "F6", does: "next group of panels", group: "Look", run: focusNextGroup },
  {
    key: "k",
    shown: "Ctrl K",
    withControl: true,
    does: "search panels, scenarios, equations, devices, settings, places",
    group: "Look",
    run: openSearch,
  },
  { key: "?", shown: "?", does: "this sheet", group: "Look", run: actions.keys },
  ...Object.entries(PAGES).map(
    ([name, { key, title, needs }]): KeyBinding => ({
      key,
      shown: key.toUpperCase(),
      does: title,
      group: "Pages",
      needs,
      run: () => actions.page(name as PageName),
    }),
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
