import { openPlace, useView } from "../bench/view-store";

const PARAMETER = "present";

/** Show only what an audience looks at, on the whole screen where the browser lets it; or all again. */
export function setPresent(present: boolean): void {
  if (present) openPlace("bench", "", true);
  const url = new URL(window.location.href);
  if (present) url.searchParams.set(PARAMETER, "1");
  else url.searchParams.delete(PARAMETER);
  window.history.replaceState(null, "", url);
  useView.setState({ present });
  if (present) document.documentElement.requestFullscreen?.().catch(() => undefined);
  else if (document.fullscreenElement) void document.exitFullscreen();
}

export const togglePresent = () => setPresent(!useView.getState().present);

/** Escape leaves the whole screen before the page hears of the key; what is presented ends with it. */
export function followFullScreen(): () => void {
  const changed = () => {
    if (!document.fullscreenElement && useView.getState().present) setPresent(false);
  };
  document.addEventListener("fullscreenchange", changed);
  return () => document.removeEventListener("fullscreenchange", changed);
}
