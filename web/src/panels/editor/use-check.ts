import { useDebouncedValue } from "@mantine/hooks";
import { useMemo } from "react";
import { useAsked, useLast } from "../../api/queries";
import type { CheckedUnit, UnitMistake } from "../../api/types";
import { units } from "../../api/units";
import { isUnitName, nameOfClass, useDraft } from "../../bench/unit-draft";

/** Pause in typing after which a text is checked. */
const PAUSE_MS = 300;

export interface Check {
  /** The text and the name that were checked. */
  name: string;
  source: string;
  unit: CheckedUnit | null;
  errors: UnitMistake[];
}

export interface Checked {
  /** The check of the text of now; undefined while it runs. */
  now: Check | undefined;
  /** The newest unit that passed: its facts stay while the text changes. */
  unit: CheckedUnit | undefined;
  /** Why the server would not check. */
  refusal: string | undefined;
}

/** The name for the check of a text without an allowed name. */
const checkedName = (name: string, source: string): string => (isUnitName(name) ? name : nameOfClass(source) || "unit");

/** Checks the text of the draft after each pause in typing. */
export function useCheck(): Checked {
  const name = useDraft((s) => checkedName(s.name, s.source));
  const source = useDraft((s) => s.source);
  const draft = useMemo(() => ({ name, source }), [name, source]);
  const [wanted] = useDebouncedValue(draft, PAUSE_MS);
  const { answer, refusal } = useAsked(
    wanted.source.trim() ? ["unit check", wanted] : undefined,
    async (): Promise<Check> => ({ ...wanted, ...(await units.check(wanted.name, wanted.source)) }),
  );
  const now = answer?.source === source && answer.name === name ? answer : undefined;
  const unit = useLast(answer?.unit ?? undefined);
  return { now, unit: source.trim() ? unit : undefined, refusal: refusal?.body.message };
}
