import { type ChildProcess, spawn } from "node:child_process";
import { once } from "node:events";
import { join } from "node:path";
import { freePort, LabServer } from "./lab-server";

const ROOT = join(import.meta.dirname, "..", "..");

/** nginx with TLS as the documents set it up, and a server of its own behind it. */
export class ProxyServer {
  readonly lab: LabServer;
  private readonly process: ChildProcess;

  private constructor(lab: LabServer, process: ChildProcess) {
    this.lab = lab;
    this.process = process;
  }

  /** Serve the page at `https://lab.example:<port><prefix>/`. */
  static async create(prefix: string): Promise<ProxyServer> {
    const port = await freePort();
    const lab = await LabServer.create({ COMBBENCH_PUBLIC_ORIGIN: `https://lab.example:${port}${prefix}` });
    const command = ["-m", "tests.server.nginx", String(port), String(lab.port), prefix];
    const child = spawn(join(ROOT, ".venv", "bin", "python"), command, {
      cwd: ROOT,
      stdio: ["pipe", "pipe", "inherit"],
    });
    const ready = await Promise.race([once(child.stdout, "data"), once(child, "exit").then(() => undefined)]);
    if (!ready) throw new Error("nginx did not start");
    return new ProxyServer(lab, child);
  }

  async destroy(): Promise<void> {
    const ended = once(this.process, "exit");
    this.process.stdin?.end();
    await ended;
    await this.lab.destroy();
  }
}
