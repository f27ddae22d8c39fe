import type { KeyboardEvent } from "react";

/** The attributes of a part of a drawing that acts as a button; SVG has none. */
export const pressable = (press: () => void, isPressed?: boolean) => ({
  role: "button",
  tabIndex: 0,
  "aria-pressed": isPressed,
  onClick: press,
  onKeyDown(event: KeyboardEvent) {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    event.stopPropagation();
    press();
  },
});
