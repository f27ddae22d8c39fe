import type { components } from "../api/schema";
import type { Bench, Command } from "../api/types";

type Schemas = components["schemas"];

/** Version of the wire format; also the subprotocol offered to the server. */
export const WIRE_VERSION = 2;
export const SUBPROTOCOL = `combbench.v${WIRE_VERSION}`;

export type Trigger = Required<Schemas["TriggerSpec"]>;

export type CaptureList = Schemas["CaptureList"];
export type CaptureMark = Schemas["CaptureMark"];

export type Subscription = { signals: string[]; width: number; behind?: Required<Schemas["BehindSpec"]>[] } & (
  | { mode: "roll"; window_ms: number }
  | { mode: "frozen"; start_tick: number; end_tick: number; window_ms?: number; trigger?: Trigger }
  | { mode: "triggered"; window_ms: number; trigger: Trigger }
);

/** How many traces its pictures have: each bench behind has all signals once more. */
export const tracesOf = ({ signals, behind = [] }: Subscription): number => signals.length * (1 + behind.length);

export type ClientMessage =
  | ({ type: "subscribe"; panel: number } & Subscription)
  | Schemas["Unsubscribe"]
  | Schemas["Rearm"]
  | Schemas["Ack"]
  | Schemas["Took"]
  | Schemas["Resume"]
  | Schemas["Pong"]
  | { type: "command"; id: string; command: Command };

/** A status leaves the parameters out while they are as before. */
export type Status = Omit<Schemas["Status"], "parameters"> & { parameters: Bench["parameters"] | null };

export type ServerMessage =
  | Schemas["Hello"]
  | Status
  | Schemas["EventsMessage"]
  | Schemas["Narrated"]
  | CaptureList
  | Schemas["Reply"]
  | Schemas["ErrorMessage"]
  | Schemas["Notice"]
  | Schemas["Ping"];
