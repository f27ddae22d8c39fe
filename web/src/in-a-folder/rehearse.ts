import type { FileDocument } from "../in-a-file/file-document";
import { bytesOf, unpacked } from "../in-a-file/pack";
import type { ClientMessage } from "../stream/wire";
import { type FolderAnswers, FolderServer } from "./folder-server";
import type { FromWorker, ToWorker } from "./messages";

/** A message of a page to its stream, or a question of its REST calls. */
type Line = ClientMessage | { method: string; path: string; body?: Record<string, unknown> };

const CHANNEL = 1;

/** Play the lines of a page on the server of a folder; all that it says to each of them, frames in base 64. */
export async function rehearse(
  code: string,
  pack: string,
  answers: FolderAnswers,
  lines: Line[],
): Promise<unknown[][]> {
  let statuses = 0;
  let said: unknown[] = [];
  const server = new FolderServer(
    await bytesOf(code),
    unpacked<FileDocument>(await bytesOf(pack)),
    answers,
    (message) => take(message),
  );
  const ask = (message: ToWorker) => server.hear(message);
  const take = (message: FromWorker) => {
    if ("ask" in message) said.push({ status: message.status, body: message.body });
    else if ("data" in message && typeof message.data === "string") {
      const words = JSON.parse(message.data);
      said.push(words);
      if (words.type === "status")
        void ask({ channel: CHANNEL, text: JSON.stringify({ type: "took", statuses: ++statuses }) });
    } else if ("data" in message) {
      const bytes = new Uint8Array(message.data as ArrayBuffer);
      said.push({ frame: btoa(bytes.reduce((text, byte) => text + String.fromCharCode(byte), "")) });
      const frame = new DataView(bytes.buffer).getUint32(4, true);
      void ask({ channel: CHANNEL, text: JSON.stringify({ type: "ack", frame }) });
    }
  };
  await server.begin();
  await ask({ channel: CHANNEL, open: answers.bench.id });
  const all: unknown[][] = [];
  for (const line of lines) {
    said = [];
    if ("type" in line) await ask({ channel: CHANNEL, text: JSON.stringify(line) });
    else await ask({ ask: 1, query: "", body: {}, ...line });
    server.turn(all.length * 1000); // each picture is due
    all.push(said);
  }
  return all;
}
