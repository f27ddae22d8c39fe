import { stream } from "../stream/stream";
import { alarm } from "./announce";
import { useView } from "./view-store";

const PARAMETER = "bench";
const LAST = "combbench.bench";

/** The bench named in the address, if any. */
export function benchInAddress(): string | undefined {
  const hash = new URLSearchParams(window.location.hash.replace(/^#/, ""));
  const query = new URLSearchParams(window.location.search);
  return hash.get(PARAMETER) ?? query.get(PARAMETER) ?? undefined;
}

/** The bench this browser showed last. */
export const lastBench = (): string | undefined => localStorage.getItem(LAST) ?? undefined;

/** Show a bench and put it into the address, so that the link can be shared and back works. */
export function openBench(id: string, replace = false): void {
  const url = new URL(window.location.href);
  url.searchParams.set(PARAMETER, id);
  url.hash = "";
  if (replace) window.history.replaceState(null, "", url);
  else window.history.pushState(null, "", url);
  localStorage.setItem(LAST, id);
  showBench(id);
}

/** Show a bench; what was chosen and said about the one before does not concern it. */
export function showBench(id: string): void {
  useView.setState({ sample: undefined });
  alarm("");
  stream.open(id);
}
