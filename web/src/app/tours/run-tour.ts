import "driver.js/dist/driver.css";
import "./tours.css";
import { notifications } from "@mantine/notifications";
import type { Driver } from "driver.js";
import { create } from "zustand";
import { api } from "../../api/api";
import { unless } from "../../api/client";
import { storageName } from "../../api/storage-name";
import { announce } from "../../bench/announce";
import { type Before, stepAside, stepBack } from "../../bench/aside";
import { lectureRuns } from "../../bench/lecture";
import { openBench } from "../../bench/open-bench";
import { showError } from "../../bench/send";
import { setPage, useView } from "../../bench/view-store";
import { useBench } from "../../stream/bench-store";
import { layOutForScript, setLayout } from "../layouts";
import { forgetRun, type Tour, type TourStep } from "./tours";

/** The width that the bubbles of a tour need, px. */
export const TOUR_PX = 700;
/** The longest wait for the condition of a step; the step appears then in any case. */
const PATIENCE_MS = 12_000;
const SEEN = storageName("combbench.tours.seen");

/** Whether a tour is under way. */
export const useTour = create<{ runs: boolean }>(() => ({ runs: false }));

/** Whether a tour was already offered or taken in this browser. */
export const tourSeen = (): boolean => localStorage.getItem(SEEN) !== null;
const noteTourSeen = (): void => localStorage.setItem(SEEN, "yes");

/** Drive the page through a tour on a bench of its own, and put all back when it ends or is left. */
export async function startTour(tour: Tour): Promise<void> {
  if (useTour.getState().runs || lectureRuns()) return;
  if (window.innerWidth < TOUR_PX) {
    notifications.show({ title: "This page is too narrow for a tour", message: "Take it on a wider screen." });
    return;
  }
  useTour.setState({ runs: true });
  useView.setState({ dialog: "none" });
  noteTourSeen();
  let before: Before | undefined;
  let bench: string | undefined;
  try {
    before = await stepAside();
    const { driver } = await import("driver.js");
    bench = (await api.createBench({ scenario: "first-look", paused: false })).id;
    setPage("bench");
    openBench(bench, true);
    await until(() => useBench.getState().bench?.id === bench);
    layOutForScript("lab");
    await guide(driver, tour);
  } catch (error) {
    showError(error);
  } finally {
    await putBack(before, bench).catch(showError);
    await forgetRun().catch(showError);
    useTour.setState({ runs: false });
    announce("The tour has ended; all is as it was before.");
  }
}

/** Show the bubbles one after another; resolves when the last is closed, or the tour is left. */
function guide(driver: (config: object) => Driver, tour: Tour): Promise<void> {
  return new Promise((ended) => {
    let busy = false;
    const leave = () => {
      shown.destroy();
      ended();
    };
    const go = async (shown: Driver, to: number) => {
      if (busy) return;
      busy = true;
      await prepare(tour.steps[to]).catch(showError);
      busy = false;
      if (shown.isActive()) shown.moveTo(to);
    };
    const shown: Driver = driver({
      steps: tour.steps.map(({ title, text, at }) => ({
        element: () => at() ?? document.body,
        popover: { title, description: text },
      })),
      animate: !window.matchMedia("(prefers-reduced-motion: reduce)").matches,
      showProgress: true,
      progressText: "{{current}} of {{total}}",
      nextBtnText: "Next",
      prevBtnText: "Back",
      doneBtnText: "Done",
      smoothScroll: false,
      disableActiveInteraction: true,
      onNextClick: () => {
        const at = (shown.getActiveIndex() ?? 0) + 1;
        if (at < tour.steps.length) void go(shown, at);
        else leave();
      },
      onPrevClick: () => shown.movePrevious(),
      // driver.js does not call its last hook if the target of the last bubble has gone
      onDestroyStarted: () => leave(),
    });
    void prepare(tour.steps[0])
      .catch(showError)
      .then(() => shown.drive());
  });
}

async function prepare({ does, until: met, at }: TourStep): Promise<void> {
  await does?.();
  await until(() => (met?.() ?? true) && at() !== undefined);
}

/** Wait for a condition of the page, for a limited time. */
async function until(met: () => boolean): Promise<void> {
  const end = Date.now() + PATIENCE_MS;
  while (!met() && Date.now() < end) await new Promise((again) => setTimeout(again, 50));
}

async function putBack(before: Before | undefined, bench: string | undefined): Promise<void> {
  useView.setState({ sample: undefined });
  if (before) {
    await stepBack(before);
    setLayout(before.layout);
  }
  if (!bench) return;
  await api.removeBench(bench).catch(unless(404));
}
