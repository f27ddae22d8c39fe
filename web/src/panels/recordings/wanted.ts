import type { Document, Wanted } from "../../api/types";
import { type Condition, conditionText } from "../condition/condition";

/** What the form asks to be recorded; times in ms of the device. */
export interface RecordDraft {
  name: string;
  pastMs: number;
  /** 0: until it is stopped. */
  lengthMs: number;
  /** When it begins; without a signal at once. */
  when: Condition;
}

export const NEW_DRAFT: RecordDraft = { name: "", pastMs: 1, lengthMs: 0, when: { signal: "", above: true, level: 0 } };

/** The request of a draft, in ticks. */
export function wantedOf(draft: RecordDraft, dtMs: number, layout: Document | undefined): Wanted {
  const ticks = (ms: number) => Math.max(0, Math.round(ms / dtMs));
  return {
    name: draft.name.trim() || "recording",
    past_ticks: ticks(draft.pastMs),
    ticks: draft.lengthMs > 0 ? Math.max(1, ticks(draft.lengthMs)) : null,
    when: draft.when.signal ? conditionText(draft.when) : null,
    layout: layout ?? null,
  };
}
