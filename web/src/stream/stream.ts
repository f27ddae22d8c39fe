import type { Stream } from "./create-stream";

/** The page's single stream; the page makes it before it shows anything. */
export let stream: Stream;

/** Put another stream in place; the one before ends. */
export function setStream(made: Stream): void {
  stream?.close();
  stream = made;
}
