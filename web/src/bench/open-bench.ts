import { api } from "../api/api";
import { may, useMe } from "../api/me";
import { storageName } from "../api/storage-name";
import { useBench } from "../stream/bench-store";
import { stream } from "../stream/stream";
import { alarm, announce } from "./announce";
import { send } from "./send";
import { useView } from "./view-store";

const PARAMETER = "bench";
const OWN = storageName("combbench.own");
const MINE = storageName("combbench.mine");

/** The bench, link or layout that the address names. */
export function inAddress(name: "bench" | "link" | "layout"): string | undefined {
  const hash = new URLSearchParams(window.location.hash.replace(/^#/, ""));
  const query = new URLSearchParams(window.location.search);
  return hash.get(name) ?? query.get(name) ?? undefined;
}

/** The bench named in the address, if any. */
export const benchInAddress = (): string | undefined => inAddress(PARAMETER);

/** The bench this browser made last, to come back to. */
export const ownBench = (): string | undefined => localStorage.getItem(OWN) ?? undefined;

/** Forget it, and the bench in the address. */
export function forgetOwnBench(): void {
  localStorage.removeItem(OWN);
  const url = new URL(window.location.href);
  url.searchParams.delete(PARAMETER);
  window.history.replaceState(null, "", url);
}

/** The links made in this browser. */
export const ownLinks = (): string[] => JSON.parse(localStorage.getItem(MINE) ?? "[]") as string[];

/** Remember a link as made here. */
export const noteOwnLink = (id: string): void => localStorage.setItem(MINE, JSON.stringify([...ownLinks(), id]));

/** Show a bench made from this page, and come back to it from now on; the new bench of a student replaces the old one. */
export function openOwn(id: string, replace = false): void {
  const hasSeveral = may("branch");
  if (hasSeveral) localStorage.setItem(OWN, id);
  openBench(id, replace || !hasSeveral);
}

/** Show a bench and put it into the address, so that others can join it and back works. `keep`: see `stream.open`. */
export function openBench(id: string, replace = false, keep = false): void {
  const url = new URL(window.location.href);
  url.searchParams.delete("link");
  url.searchParams.set(PARAMETER, id);
  url.hash = "";
  if (replace) window.history.replaceState(null, "", url);
  else window.history.pushState(null, "", url);
  showBench(id, keep);
}

/** Show a bench; the selection and the alarm of the previous bench are cleared. */
export function showBench(id: string, keep = false): void {
  useView.setState({ sample: undefined });
  alarm("");
  useMe.setState({ at: id });
  stream.open(id, keep);
}

let before: string | undefined;

/** The bench a replay was begun from, to go back to. */
export const benchBefore = (): string | undefined => before;

/** Play a recording in this page. */
export async function openReplay(recording: string): Promise<void> {
  const from = useBench.getState().bench;
  if (from && !from.replay_of) before = from.id;
  openBench((await api.replay(recording)).id);
}

/**
 * Show a new bench in place of the one on the page.
 *
 * The one before is paused if no other page watches it, so that going back finds it as it was.
 */
export async function openInstead(id: string): Promise<void> {
  const { bench } = useBench.getState();
  // the previous bench of a student is gone
  if (may("branch") && bench?.state === "running" && (bench.watchers ?? 0) <= 1) await send({ kind: "pause" });
  openOwn(id);
}

/** Begin the bench again from tick 0 with values written over it, as a bench of its own. */
export async function openVariant(set: Record<string, unknown>, said: string): Promise<void> {
  const { bench } = useBench.getState();
  if (!bench) return;
  await openInstead((await api.variant(bench.id, set)).id);
  announce(said);
}
