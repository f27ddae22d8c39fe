import { type ChildProcess, spawn } from "node:child_process";
import { once } from "node:events";
import { join } from "node:path";
import { expect, type Page } from "@playwright/test";
import { freePort, LabServer } from "./lab-server";

const ROOT = join(import.meta.dirname, "..", "..");

/** A browser that finds lab.example on this machine. */
export const PROXY_BROWSER = {
  launchOptions: {
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    // each connection with a certificate of its own making would begin the request anew, until Chromium gives it up
    args: [
      "--no-sandbox",
      "--disable-gpu",
      "--host-resolver-rules=MAP lab.example 127.0.0.1",
      "--ignore-certificate-errors",
    ],
  },
};

/** nginx with TLS as the documents set it up, and a server of its own behind it. */
export class ProxyServer {
  readonly lab: LabServer;
  private readonly process: ChildProcess;

  private constructor(lab: LabServer, process: ChildProcess) {
    this.lab = lab;
    this.process = process;
  }

  /** Serve the page at `https://lab.example:<port><prefix>/`; the manual clock is for loopback alone. */
  static async create(prefix: string): Promise<ProxyServer> {
    const port = await freePort();
    const lab = await LabServer.create({
      COMBBENCH_CLOCK: "machine",
      COMBBENCH_PUBLIC_ORIGIN: `https://lab.example:${port}${prefix}`,
    });
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

/** Open a bench behind the proxy: its cookie, its stream, its 3D view, its links. */
export async function walkBehindProxy(page: Page, prefix: string): Promise<void> {
  const proxy = await ProxyServer.create(prefix);
  const refused: string[] = [];
  page.on("response", (answer) => answer.status() >= 400 && refused.push(`${answer.status()} ${answer.url()}`));
  page.on("requestfailed", (request) => refused.push(`${request.failure()?.errorText} ${request.url()}`));
  try {
    const base = proxy.lab.url.replace(/\?.*/, "");
    await page.goto(proxy.lab.url);
    await expect(page).toHaveURL(new RegExp(`^${base}\\?bench=`));
    await expect(page.getByTestId("bench-state")).toHaveText("running");
    const cookies = await page.context().cookies();
    expect(cookies.map(({ secure, path }) => ({ secure, path }))).toEqual([{ secure: true, path: `${prefix}/` }]);
    const clock = page.getByRole("timer", { name: "Device time" });
    const before = await clock.innerText();
    await expect(clock).not.toHaveText(before);
    await expect(page.getByText("The 3D view is loading")).toBeVisible();
    await expect(page.getByText("The 3D view is loading")).toHaveCount(0); // it goes once the scene is connected
    await page.keyboard.press("Shift+S");
    const link = page.getByRole("textbox", { name: "Link", exact: true });
    await expect(link).toHaveValue(new RegExp(`^${base}\\?link=[2-9a-z]{8}$`));
    await expect(page.getByText("cannot reach this address")).toHaveCount(0);
    const icon = page.locator("img[src='./comb.svg']");
    await expect.poll(() => icon.evaluate((img) => (img as HTMLImageElement).naturalWidth)).toBeGreaterThan(0);
    await page.goto(`${base}theory/5.2.3.2`);
    await expect(page).toHaveTitle("5.2.3.2 | Theory | CombBench");
    await expect(page.getByRole("heading", { name: "Theory" })).toBeVisible();
    await expect(page.getByTestId("bench-state")).toHaveText("running");
    expect(refused.filter((line) => !line.includes("ERR_ABORTED"))).toEqual([]);
    const nowhere = await page.goto(`${base}no/such/place`);
    expect(nowhere?.status()).toBe(404);
    await expect(page.getByText("Page not found")).toBeVisible();
  } finally {
    await proxy.destroy();
  }
}
