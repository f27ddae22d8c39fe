import { useMantineColorScheme } from "@mantine/core";
import { useEffect } from "react";
import { useView } from "../bench/view-store";
import { useScheme } from "../ui/use-canvas";
import { keymap } from "./keymap";
import { followFullScreen, setPresent } from "./present";
import { isSearching } from "./search/search";
import { themeSwitch } from "./theme";

const TYPING =
  "input, textarea, select, [contenteditable], [role=slider], [role=menu], [role=listbox], [role=radiogroup]";

const CHOSEN = "select, input[type=radio], input[type=checkbox]";

/** Whether the pointer was used last, rather than the keys. */
let pointed = false;
const notePointer = () => {
  pointed = true;
};
const noteKey = () => {
  pointed = false;
};

/** A choice by pointer returns the keys to the page; a choice by keys keeps the focus. */
function giveBack({ target }: Event): void {
  if (pointed && target instanceof HTMLElement && target.matches(CHOSEN)) target.blur();
}

/** Who leaves a field, or the list it opened, with Escape has the keys again. */
function leave({ key, target }: KeyboardEvent): void {
  if (key === "Escape" && target instanceof HTMLElement && target.matches("input, textarea, select")) target.blur();
}

/** Who presents leaves with Escape, unless it closes something on the page. */
function endPresenting({ key, defaultPrevented, target }: KeyboardEvent): void {
  if (key !== "Escape" || defaultPrevented || (target as HTMLElement).closest(TYPING)) return;
  if (useView.getState().present) setPresent(false);
}

/** Listens for the page's keys, except while something else wants them. */
export function useKeys(): void {
  const scheme = useScheme();
  const { setColorScheme } = useMantineColorScheme();
  useEffect(() => {
    themeSwitch.flip = () => setColorScheme(scheme === "dark" ? "light" : "dark");
  }, [scheme, setColorScheme]);

  useEffect(() => {
    const listen = (event: KeyboardEvent) => {
      if (event.defaultPrevented || event.altKey || isSearching()) return;
      const target = event.target as HTMLElement;
      if (target.closest(TYPING)) return;
      if (event.key === " " && target.closest("button, a, summary, [role=button], [role=tab]")) return;
      const binding = keymap().find((b) => b.key === event.key && b.withControl === (event.ctrlKey || event.metaKey));
      if (!binding) return;
      event.preventDefault();
      binding.run();
    };
    const stop = new AbortController();
    const { signal } = stop;
    window.addEventListener("keydown", listen, { signal });
    window.addEventListener("keydown", leave, { signal });
    window.addEventListener("keydown", endPresenting, { signal });
    window.addEventListener("keydown", noteKey, { capture: true, signal });
    window.addEventListener("pointerdown", notePointer, { capture: true, signal });
    window.addEventListener("change", giveBack, { signal });
    const unfollow = followFullScreen();
    return () => {
      stop.abort();
      unfollow();
    };
  }, []);
}
