import type { components } from "../api/schema";
import type { Bench, Command } from "../api/types";

type Schemas = components["schemas"];

/** Version of the wire format; also the subprotocol offered to the server. */
export const WIRE_VERSION = 2;
export const SUBPROTOCOL = `combbench.v${WIRE_VERSION}`;

export type Trigger = Required<Schemas["TriggerSpec"]>;

export type Subscription =
  | { mode: "roll"; signals: string[]; window_ms: number; width: number }
  | { mode: "frozen"; signals: string[]; start_tick: number; end_tick: number; width: number }
  | { mode: "triggered"; signals: string[]; window_ms: number; width: number; trigger: Trigger };

export type ClientMessage =
  | ({ type: "subscribe"; panel: number } & Subscription)
  | Schemas["Unsubscribe"]
  | Schemas["Rearm"]
  | Schemas["Ack"]
  | Schemas["Resume"]
  | Schemas["Pong"]
  | { type: "command"; id: string; command: Command };

/** A status leaves the parameters out while they are as before. */
export type Status = Omit<Schemas["Status"], "parameters"> & { parameters: Bench["parameters"] | null };

export type ServerMessage =
  | Schemas["Hello"]
  | Status
  | Schemas["Events"]
  | Schemas["Narrated"]
  | Schemas["Reply"]
  | Schemas["ErrorMessage"]
  | Schemas["Notice"]
  | Schemas["Ping"];
