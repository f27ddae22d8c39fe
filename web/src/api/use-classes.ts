import { classes } from "./classes";
import { useMay } from "./me";
import { useAnswer } from "./queries";
import type { Class } from "./types";

const NONE: Class[] = [];
const USUAL_MS = 5000;

/** The classes of this server; only the teacher gets any. A page that got none does not ask again. */
export function useClasses(): { all: Class[]; again(): void } {
  const teaches = useMay("teach");
  const { value, again } = useAnswer(teaches ? ["classes"] : undefined, classes.all, (found) =>
    found?.length ? USUAL_MS : undefined,
  );
  return { all: value ?? NONE, again };
}
