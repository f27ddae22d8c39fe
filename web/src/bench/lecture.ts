import { create } from "zustand";
import { api } from "../api/api";
import { ApiError, unless } from "../api/client";
import { lectures } from "../api/lectures";
import { storageName } from "../api/storage-name";
import type { Cue, Lecture } from "../api/types";
import { useBench } from "../stream/bench-store";
import { jump } from "../ui/hover";
import { announce } from "./announce";
import { type Before, stepAside, stepBack } from "./aside";
import { openBench } from "./open-bench";
import { showError, showing } from "./send";
import { setPage, useView } from "./view-store";

const KEPT = storageName("combbench.lecture");

interface LectureStore {
  lecture: Lecture | undefined;
  /** The cue the page is at, from 0. */
  at: number;
  /** The tick the cue begins at. */
  tick: number;
  /** Wall time at which the lecture began, ms. */
  began: number;
  /** The bench the cues are put on. */
  stage: string | undefined;
  before: Before | undefined;
  busy: boolean;
}

const NONE = { lecture: undefined, at: 0, tick: 0, began: 0, stage: undefined, before: undefined, busy: false };

/** Address of the notes of a lecture alone, for a phone or another machine. */
export const notesOf = (id: string): string => `./?notes=${encodeURIComponent(id)}`;

/** The lecture that runs on this page. */
export const useLecture = create<LectureStore>(() => NONE);

export const lectureRuns = (): boolean => useLecture.getState().lecture !== undefined;

export const cueNow = (): Cue | undefined => {
  const { lecture, at } = useLecture.getState();
  return lecture?.script[at];
};

/** The layout of a cue: its own, else the layout of the cue before. */
export function layoutAt(script: readonly Pick<Cue, "layout">[], at: number): "lecture" | "lab" | "research" {
  const found = script.slice(0, at + 1).findLast(({ layout }) => layout)?.layout;
  return (found ?? "lecture") as "lecture" | "lab" | "research";
}

/** Minutes planned up to the end of a cue. */
export const plannedTo = (script: readonly Pick<Cue, "minutes">[], at: number): number =>
  script.slice(0, at + 1).reduce((sum, { minutes }) => sum + minutes, 0);

/** Begin a lecture at its first cue. The bench on the page pauses if no other page watches it. */
export const startLecture = showing(async (id: string) => {
  if (lectureRuns()) await leaveLecture();
  const lecture = await lectures.get(id);
  const before = await stepAside();
  useLecture.setState({ ...NONE, lecture, before, at: -1, began: Date.now() });
  setPage("bench");
  await goTo(0);
});

let wanted = 0;

/** Go to a cue, forwards or back; the bench is put into its exact state. Of many presses at once the last one counts. */
export async function goTo(cue: number): Promise<void> {
  const { lecture, busy } = useLecture.getState();
  if (!lecture) return;
  wanted = Math.max(0, Math.min(lecture.script.length - 1, cue));
  if (busy) return;
  useLecture.setState({ busy: true });
  try {
    let reached = -1;
    while (reached !== wanted && useLecture.getState().lecture === lecture) {
      reached = wanted;
      await put(lecture, reached);
    }
  } catch (error) {
    showError(error);
  } finally {
    useLecture.setState({ busy: false });
  }
}

async function put(lecture: Lecture, at: number): Promise<void> {
  const { stage } = useLecture.getState();
  const { bench, tick } = await lectures.put(lecture.id, at + 1, stage ?? null).catch((error: unknown) => {
    // a stage that was closed elsewhere is made anew
    if (stage && error instanceof ApiError && error.status === 404) return lectures.put(lecture.id, at + 1, null);
    throw error;
  });
  jump.to("live");
  // on a phone the vote of the cue before leaves the place to the lanes
  useView.setState(({ extra }) => ({ sample: undefined, extra: extra === "vote" ? "" : extra }));
  if (bench.id !== stage || bench.id !== useBench.getState().bench?.id) openBench(bench.id, true);
  if (stage && bench.id !== stage) await remove(stage);
  useLecture.setState({ at, tick, stage: bench.id });
  keep();
  announce(`Cue ${at + 1} of ${lecture.script.length}: ${lecture.script[at].title}`);
}

/** A press further on or back counts from where the last one leads. */
const from = () => (useLecture.getState().busy ? wanted : useLecture.getState().at);
export const nextCue = () => void goTo(from() + 1);
export const cueBefore = () => void goTo(from() - 1);

/** End the lecture; returns the state to which the page goes back. */
export async function leaveLecture(): Promise<Before | undefined> {
  const { lecture, before, stage } = useLecture.getState();
  if (!lecture) return undefined;
  useLecture.setState(NONE);
  sessionStorage.removeItem(KEPT);
  try {
    if (before) await stepBack(before);
  } catch (error) {
    showError(error);
  }
  if (stage && before?.bench) await remove(stage);
  return before;
}

/** Go on with the lecture of this tab after the page was loaded again. */
export async function resumeLecture(): Promise<void> {
  const kept = sessionStorage.getItem(KEPT);
  if (!kept || lectureRuns()) return;
  const { id, ...rest } = JSON.parse(kept) as { id: string } & Omit<LectureStore, "lecture" | "busy">;
  try {
    useLecture.setState({ ...NONE, ...rest, lecture: await lectures.get(id) });
  } catch {
    sessionStorage.removeItem(KEPT);
  }
}

function keep(): void {
  const { lecture, at, tick, began, stage, before } = useLecture.getState();
  if (lecture) sessionStorage.setItem(KEPT, JSON.stringify({ id: lecture.id, at, tick, began, stage, before }));
}

const remove = (bench: string) => api.removeBench(bench).catch(unless(404));
