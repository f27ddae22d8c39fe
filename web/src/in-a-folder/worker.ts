import type { FileDocument } from "../in-a-file/file-document";
import { inflated, unpacked } from "../in-a-file/pack";
import { type FolderAnswers, FolderServer } from "./folder-server";
import type { FromWorker, ToWorker } from "./messages";

const TURN_MS = 15;
const host = self as unknown as {
  postMessage(message: FromWorker, moved: Transferable[]): void;
  onmessage: ((event: MessageEvent<ToWorker>) => void) | null;
};
const folder = new URL(self.name);

const part = async (name: string) => {
  const answer = await fetch(new URL(name, folder));
  if (!answer.ok) throw new Error(`${name} is missing: ${answer.status}`);
  return inflated(new Uint8Array(await answer.arrayBuffer()));
};

/** Questions of the page wait until the bench is here. */
const begun = (async () => {
  const [code, pack, answers] = await Promise.all(["code.bin", "pack.bin", "answers.bin"].map(part));
  const known = JSON.parse(new TextDecoder().decode(answers)) as FolderAnswers;
  const server = new FolderServer(code, unpacked<FileDocument>(pack), known, (message, moved = []) =>
    host.postMessage(message, moved),
  );
  const turn = () => {
    const began = performance.now();
    server.turn(began);
    setTimeout(turn, Math.max(0, TURN_MS - (performance.now() - began)));
  };
  turn();
  return server;
})();

host.onmessage = async ({ data }) => (await begun).hear(data);
