import type { Parameter } from "../../api/types";
import { formatCount, formatShort } from "../../ui/format";
import type { FaultDraft } from "./fault-draft";

export interface SeverityScale {
  /** The severity parameter is a share, shown in percent. */
  percent: boolean;
  /** Ends of the slider, in the server's unit. */
  low: number;
  high: number;
  minimum: number;
  maximum: number;
}

/** How a fault's severity is shown: a share as percent, on a slider that spans what is usual rather than all that is allowed. */
export function severityScale(parameter: Parameter | undefined, suggested: number): SeverityScale {
  const minimum = parameter?.minimum ?? -1;
  const maximum = parameter?.maximum ?? 1;
  const percent = !parameter?.unit || parameter.unit === "1";
  const reach = Math.max(Math.abs(suggested) * 10, percent ? 0.5 : 0);
  return {
    percent,
    minimum,
    maximum,
    low: Math.max(minimum, Math.min(0, minimum < 0 ? -reach : minimum)),
    high: Math.min(maximum, reach),
  };
}

export function severityText(value: number, scale: SeverityScale, unit: string): string {
  const shown = scale.percent ? value * 100 : value;
  const text = /^[a-z]{4,}$/.test(unit) ? formatCount(shown, unit) : formatShort(shown, scale.percent ? "%" : unit, 3);
  return value > 0 ? `+${text}` : text;
}

/** The severity a draft asks for; a dash while its field holds no number. */
export const draftSeverity = (
  { severity }: Pick<FaultDraft, "severity">,
  scale: SeverityScale,
  unit: string,
): string => (typeof severity === "number" ? severityText(severity, scale, unit) : "–");
