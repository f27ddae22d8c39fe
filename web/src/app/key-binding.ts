import type { Right } from "../api/me";

export interface KeyBinding {
  /** `KeyboardEvent.key`, as typed. */
  key: string;
  shown: string;
  /** With Ctrl, or Command where there is one. */
  withControl: boolean;
  does: string;
  group: "Run" | "Look" | "Bench" | "Pages";
  /** The rights that the key needs. */
  needs: Right[];
  run(): void;
}

/** Makes the keys of a group; a key shown with Ctrl needs it. */
export const keyOf =
  (group: KeyBinding["group"], ...needs: Right[]) =>
  (key: string, shown: string, does: string, run: () => void): KeyBinding => ({
    key,
    shown,
    withControl: shown.startsWith("Ctrl"),
    does,
    group,
    needs,
    run,
  });
