import { notifications } from "@mantine/notifications";
import { api } from "../api/api";
import { ApiError } from "../api/client";
import { askMe, may, useMe } from "../api/me";
import type { Bench } from "../api/types";
import type { SharedLayout } from "../bench/dock";
import { benchInAddress, inAddress, openBench, openInstead, openOwn, ownBench, showBench } from "../bench/open-bench";
import { formatTick } from "../ui/format";
import { follow } from "./follow";
import { showShared } from "./layouts";

/** Worth seeing at first sight: the first of these that the library has. */
const SHOWPIECES = ["first-look", "live", "ch5-seven-step"];

/** Longer than this takes about a second to repeat. */
const LONG_TICKS = 300_000;

/** Open the experiment or the bench in the address, else the bench of this browser. A student or a watcher has one bench. */
export async function openFirstBench(): Promise<void> {
  const { role } = await askMe();
  if (!may("branch", role)) return follow();
  const link = inAddress("link");
  if (link) return openLink(link, true);
  const named = benchInAddress();
  if (!named) return openOwnBench();
  await broughtBack(named);
  // meanwhile another bench may have been opened: a lecture of this tab that is left at once goes back to its own
  if (benchInAddress() === named) openBench(named, true); // a closed bench shows its own notice
}

/** Open the experiment of a link on a fresh bench, with its layout. */
export async function openLink(id: string, replace = false): Promise<void> {
  const { content, title, tick } = await api.link(id);
  const notice = `link-${id}`;
  if ((tick ?? 0) > LONG_TICKS)
    notifications.show({
      id: notice,
      loading: true,
      autoClose: false,
      title: "Replaying the commands",
      message: `${title}, to ${formatTick(tick ?? 0)}.`,
    });
  const bench = await api.openLink(id).finally(() => notifications.hide(notice));
  openOwn(bench.id, replace);
  if (content.layout) showShared(content.layout as unknown as SharedLayout);
}

/** Start a bench of a library scenario in place of the one shown. */
export async function startAgain(scenario: string): Promise<void> {
  openOwn((await api.createBench({ scenario, paused: false, quiet_lead: true })).id, true);
}

/** Start a bench of a library scenario; the bench shown pauses if no other page watches it. */
export async function startBeside(scenario: string): Promise<void> {
  await openInstead((await api.createBench({ scenario, paused: false, quiet_lead: true })).id);
}

/** Open the bench of this browser, or a fresh one. */
export async function openOwnBench(): Promise<void> {
  const own = ownBench();
  if (own && (await broughtBack(own))) return openOwn(own, true);
  const library = await api.scenarios();
  const id = SHOWPIECES.find((name) => library.some((s) => s.id === name)) ?? library[0]?.id;
  if (!id) throw new Error("The library holds no scenario to start from.");
  await startAgain(id);
  if (own)
    notifications.show({
      title: "A fresh bench",
      message: "The server has closed your earlier bench, or let it go too long ago.",
    });
}

/** Open a bench again that the server has closed because no page watched it. A student gets another bench. */
export async function comeBack(): Promise<void> {
  if (!may("branch")) return useMe.getState().me?.role === "student" ? follow() : undefined;
  const id = benchInAddress();
  if (id && (await broughtBack(id)) && benchInAddress() === id) showBench(id);
}

/** Whether a bench is live; a bench that the server has closed is opened again first. */
async function broughtBack(id: string): Promise<boolean> {
  const live = await unlessGone(api.bench(id));
  if (live) return true;
  const back = await unlessGone(api.reopenBench(id));
  if (back)
    notifications.show({
      title: "Opened again as it was",
      message: `Nobody watched ${back.title} for a while, so the server let it go. It is back at ${formatTick(back.tick)}.`,
    });
  return back !== undefined;
}

/** The bench of an answer; undefined if it does not exist or cannot be repeated. */
async function unlessGone(answer: Promise<Bench>): Promise<Bench | undefined> {
  try {
    return await answer;
  } catch (error) {
    if (!(error instanceof ApiError) || error.body.code === "too_many_benches") throw error;
    if (error.status === 409) notifications.show({ title: "This bench was closed", message: error.body.message });
    else if (error.status !== 404) throw error;
    return undefined;
  }
}
