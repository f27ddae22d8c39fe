import type { ApiErrorBody, Bench, Command, LogEntry, Score } from "../api/types";

/** Version of the wire format; also the subprotocol offered to the server. */
export const WIRE_VERSION = 1;
export const SUBPROTOCOL = `combbench.v${WIRE_VERSION}`;

export interface Trigger {
  signal: string;
  edge: "rising" | "falling";
  level: number;
  hysteresis: number;
  position: number;
  sweep: "auto" | "normal" | "single";
}

export type Subscription =
  | { mode: "roll"; signals: string[]; window_ms: number; width: number }
  | { mode: "frozen"; signals: string[]; start_tick: number; end_tick: number; width: number }
  | { mode: "triggered"; signals: string[]; window_ms: number; width: number; trigger: Trigger };

export type ClientMessage =
  | ({ type: "subscribe"; panel: number } & Subscription)
  | { type: "unsubscribe" | "rearm"; panel: number }
  | { type: "ack"; frame: number }
  | { type: "resume"; after: number }
  | { type: "command"; id: string; command: Command };

export type ServerMessage =
  | { type: "hello"; wire: number; server: string; bench: Bench; last_event: number }
  | ({ type: "status"; scores?: Record<string, Score>; dropped_frames?: number } & Partial<Bench>)
  | { type: "event"; event: LogEntry }
  | { type: "reply"; id: string; ok: true; tick: number }
  | { type: "reply"; id: string; ok: false; error: ApiErrorBody }
  | { type: "error"; error: ApiErrorBody }
  | { type: "notice"; code: string; message: string };
