import { marksNow } from "../bench/marks";
import type { PanelFrame } from "../stream/panel-frame";
import type { EventAxis } from "./event-marks";

/** The axis of a frame of device time, with what has happened on the bench. */
export const axisOf = (
  { frame, span }: { frame: PanelFrame; span: { start: number; end: number } },
  field: EventAxis["field"],
): EventAxis => ({ span, dtMs: frame.dtMs, marks: marksNow(), field });
