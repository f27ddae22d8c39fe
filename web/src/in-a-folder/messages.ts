/** From the page to the worker: a question of its REST calls, or of one of its streams. */
export type ToWorker =
  | { ask: number; method: string; path: string; query: string; body: Record<string, unknown> }
  | { channel: number; open: string }
  | { channel: number; text: string }
  | { channel: number; close: true };

export type FromWorker =
  | { ask: number; status: number; body: unknown }
  | { channel: number; opened: true }
  | { channel: number; data: string | ArrayBuffer }
  | { channel: number; closed: number };

/** One end of the line between page and worker. */
export interface Port {
  postMessage(message: ToWorker): void;
  onmessage: ((event: MessageEvent<FromWorker>) => void) | null;
}
