import type { Parameter } from "../api/types";
import { formatShort } from "../ui/format";

export interface SeverityScale {
  /** The severity parameter is a share, shown in percent. */
  percent: boolean;
  /** Ends of the slider, in the server's unit. */
  low: number;
  high: number;
  minimum: number;
  maximum: number;
  /** The step of the slider and of the box. */
  step: number;
}

/** Units that are counted in whole numbers. */
const WHOLE = ["pair"];

/** How a fault's severity is shown: a share as percent, on a slider over the usual range rather than the allowed one. */
export function severityScale(parameter: Parameter | undefined, suggested: number): SeverityScale {
  const minimum = parameter?.minimum ?? -1;
  const maximum = parameter?.maximum ?? 1;
  const percent = !parameter?.unit || parameter.unit === "1";
  const reach = Math.max(Math.abs(suggested) * 10, percent ? 0.5 : 0);
  const low = Math.max(minimum, Math.min(0, minimum < 0 ? -reach : minimum));
  const high = Math.min(maximum, reach);
  const isWhole = WHOLE.includes(parameter?.unit ?? "") || (high - low) * (percent ? 100 : 1) > 40;
  return { percent, minimum, maximum, low, high, step: isWhole ? 1 : 0.1 };
}

export function severityText(value: number, scale: SeverityScale, unit: string): string {
  const shown = scale.percent ? value * 100 : value;
  const noun = /^[a-z]{4,}$/.test(unit) && Math.abs(shown) !== 1 ? `${unit}s` : unit;
  const text = formatShort(shown, scale.percent ? "%" : noun, 4);
  return value > 0 ? `+${text}` : text;
}
