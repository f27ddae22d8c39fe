import { type ChildProcess, spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";

const COMBBENCH = join(import.meta.dirname, "..", "..", ".venv", "bin", "combbench");
const START_MS = 120_000;

/** Time passes by `advance` alone; so the rate of commands is not limited. Only the test of the gallery has figures made. */
const USUAL = {
  COMBBENCH_CLOCK: "manual",
  COMBBENCH_COMMAND_BURST: "100000",
  COMBBENCH_FIGURES: "false",
  COMBBENCH_RUN_WORKERS: "1",
};

/** A real server of its own: free port, empty data folder. */
export class LabServer {
  /** Address with the token in it. */
  url = "";
  readonly port: number;
  private readonly settings: Record<string, string>;
  private readonly data = mkdtempSync(join(tmpdir(), "combbench-e2e-"));
  private process: ChildProcess | undefined;
  private said = "";

  private constructor(port: number, settings: Record<string, string>) {
    this.port = port;
    this.settings = settings;
  }

  /** Start one, with settings given as environment variables. */
  static async create(settings: Record<string, string> = {}): Promise<LabServer> {
    const server = new LabServer(await freePort(), settings);
    await server.start();
    return server;
  }

  get origin(): string {
    return `http://127.0.0.1:${this.port}`;
  }

  async start(): Promise<void> {
    // packages come without bytecode, and without keeping it each start and each worker compiles them for seconds
    const env = { ...process.env, PYTHONDONTWRITEBYTECODE: "", ...USUAL, ...this.settings };
    const child = spawn(COMBBENCH, ["serve", "--port", String(this.port), "--data", this.data], { env });
    this.process = child;
    this.said = "";
    this.url = await new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`the server did not start:\n${this.said}`)), START_MS);
      const listen = (chunk: Buffer) => {
        this.said += chunk.toString();
        const address = /https?:\/\/\S+token=\S+/.exec(this.said)?.[0];
        if (!address) return;
        clearTimeout(timer);
        resolve(address);
      };
      child.stdout.on("data", listen);
      child.stderr.on("data", listen);
      child.on("exit", (code) => reject(new Error(`the server ended with ${code}:\n${this.said}`)));
    });
  }

  /** Ask the API as a script would, with the token; an answer that is not a success is an error. */
  async ask<T>(method: string, path: string, body?: object): Promise<T> {
    const token = new URL(this.url).searchParams.get("token");
    const answer = await fetch(`${this.origin}/api/v1${path}`, {
      method,
      headers: { authorization: `Bearer ${token}`, "content-type": "application/json" },
      body: body && JSON.stringify(body),
    });
    const text = await answer.text();
    if (!answer.ok) throw new Error(`${method} ${path}: ${answer.status} ${text}`);
    return (text ? JSON.parse(text) : undefined) as T;
  }

  /** Let wall time pass on all benches, s; the status of each has gone out when this returns. */
  async advance(seconds: number): Promise<void> {
    await this.ask("POST", "/testing/advance", { seconds });
  }

  /** Let a bench run for so many ticks; all benches that run do so for the same time. */
  async advanceTicks(bench: string, ticks: number): Promise<void> {
    await this.ask("POST", "/testing/advance", { bench, ticks });
  }

  /** Remove all benches, recordings, runs and campaigns. */
  async clear(): Promise<void> {
    for (const kind of ["benches", "recordings"])
      for (const { id } of await this.rows(kind)) await this.ask("DELETE", `/${kind}/${id}`);
    for (const kind of ["runs", "sweeps"]) {
      const active = async () => (await this.rows(kind)).filter(({ state }) => ["queued", "running"].includes(state));
      for (let rows = await active(); rows.length; rows = await active())
        // refused where one has ended meanwhile
        for (const { id } of rows) await this.ask("DELETE", `/${kind}/${id}`).catch(() => undefined);
      await this.ask("POST", `/${kind}/remove`, {});
    }
  }

  /** The benches, recordings, runs or campaigns that exist. */
  async rows(kind: string): Promise<{ id: string; state: string }[]> {
    return (await this.ask<Record<string, { id: string; state: string }[]>>("GET", `/${kind}`))[kind];
  }

  /** Its warnings so far, the last lines. */
  get warnings(): string[] {
    return this.said
      .split("\n")
      .filter((line) => /"level": "(WARNING|ERROR)"/.test(line))
      .slice(-5);
  }

  /** End it as an operator would. */
  async stop(): Promise<void> {
    const child = this.process;
    this.process = undefined;
    if (!child || child.exitCode !== null) return;
    const ended = new Promise((resolve) => child.once("exit", resolve));
    child.kill("SIGTERM");
    await ended;
  }

  async destroy(): Promise<void> {
    await this.stop();
    rmSync(this.data, { recursive: true, force: true });
  }
}

export function freePort(): Promise<number> {
  return new Promise((resolve, reject) => {
    const probe = createServer();
    probe.once("error", reject);
    probe.listen(0, "127.0.0.1", () => {
      const address = probe.address();
      const port = typeof address === "object" && address ? address.port : 0;
      probe.close(() => resolve(port));
    });
  });
}
