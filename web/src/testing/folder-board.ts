import { act } from "@testing-library/react";
import { expect, vi } from "vitest";
import { setAnswering } from "../api/client";
import type { Command } from "../api/types";
import { FolderServer } from "../in-a-folder/folder-server";
import type { FromWorker, Port } from "../in-a-folder/messages";
import { openFolder } from "../in-a-folder/open-folder";
import { useBench } from "../stream/bench-store";
import { createStream } from "../stream/create-stream";
import { setStream, stream } from "../stream/stream";
import { recordedFolder } from "./recorded";

/** A bench in a folder, whose worker is in this thread: the page gives it commands, and it runs by `turn` alone. */
export class FolderBoard {
  private readonly server: FolderServer;
  private now = 0;

  private constructor(server: FolderServer) {
    this.server = server;
  }

  /** Show a paused bench of a folder on the page, at its first tick. */
  static async connect(): Promise<FolderBoard> {
    const { code, document, answers } = await recordedFolder();
    let port: Port | undefined;
    const heard = (data: FromWorker) => act(() => port?.onmessage?.({ data } as MessageEvent<FromWorker>));
    const server = new FolderServer(code, document, answers, heard);
    port = { onmessage: null, postMessage: (message) => void server.hear(message) };
    const { transport, reach } = openFolder(port);
    setAnswering(reach);
    await server.begin();
    setStream(createStream(transport));
    stream.open(answers.bench.id);
    await act(() => vi.waitFor(() => expect(useBench.getState().bench?.id).toBe(answers.bench.id)));
    const board = new FolderBoard(server);
    await board.command({ kind: "pause" });
    return board;
  }

  /** Give it a command as the page does. */
  async command(command: Command): Promise<void> {
    await act(async () => void (await stream.client.command(command)));
    await this.turn();
    const isListed = () => (useBench.getState().events.at(-1)?.seq ?? 0) === useBench.getState().bench?.last_event;
    await act(() => vi.waitFor(() => expect(isListed()).toBe(true)));
  }

  /** Let it send its news. */
  async turn(): Promise<void> {
    this.now += 1000;
    await act(async () => this.server.turn(this.now));
  }
}
