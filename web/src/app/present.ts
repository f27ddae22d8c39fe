import { openPlace, useView } from "../bench/view-store";

const PARAMETER = "present";

/** Show the panels alone, on the full screen where the browser allows it; or everything again. */
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

/** Escape leaves the full screen before the page receives the key; the presentation ends with it. */
export function followFullScreen(): () => void {
  const changed = () => {
    if (!document.fullscreenElement && useView.getState().present) setPresent(false);
  };
  document.addEventListener("fullscreenchange", changed);
  return () => document.removeEventListener("fullscreenchange", changed);
}
