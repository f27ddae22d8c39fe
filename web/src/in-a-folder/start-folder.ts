import { setAnswering } from "../api/client";
import { forgetOwnBench } from "../bench/open-bench";
import type { Transport } from "../stream/transport";
import type { Port } from "./messages";
import { openFolder } from "./open-folder";

/** Start the worker of a folder: its transport for the streams of the page; it answers the calls of the page from now on. */
export function startFolder(folder: URL): Transport {
  forgetOwnBench(); // a visit begins anew: nothing is kept of the one before
  const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module", name: folder.href });
  const { transport, reach } = openFolder(worker as unknown as Port);
  setAnswering(reach);
  return transport;
}
