import { execFile } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createServer, type Server } from "node:http";
import type { AddressInfo } from "node:net";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";
import { promisify } from "node:util";
import { test as base, expect } from "@playwright/test";

const COMBBENCH = join(import.meta.dirname, "..", "..", ".venv", "bin", "combbench");
/** Below this path the folder is served, as a course page of many has it. */
const BELOW = "/courses/mems/bench/";
const EXPORT_MS = 600_000;

const TYPES: Record<string, string> = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".svg": "image/svg+xml",
  ".woff2": "font/woff2",
};

/** A plain static host: files of a folder, and nothing else. */
async function host(folder: string): Promise<{ server: Server; address: string }> {
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url ?? "/", "http://host");
    const name = pathname.startsWith(BELOW) ? normalize(pathname.slice(BELOW.length) || "index.html") : "..";
    const file = join(folder, name);
    if (name.startsWith("..") || !existsSync(file)) return response.writeHead(404).end();
    response.writeHead(200, { "Content-Type": TYPES[extname(file)] ?? "application/octet-stream" });
    return response.end(readFileSync(file));
  });
  await new Promise<void>((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { server, address: `http://127.0.0.1:${(server.address() as AddressInfo).port}${BELOW}` };
}

interface FolderFixtures {
  /** Everything that the page asked for on another host, or that its policy refused. */
  strayed: string[];
}

/** Tests on a bench in a folder, without any server of ours. */
export const test = base.extend<FolderFixtures, { address: string }>({
  address: [
    // biome-ignore lint/correctness/noEmptyPattern: the fixture depends on no other
    async ({}, use) => {
      const folder = mkdtempSync(join(tmpdir(), "combbench-folder-"));
      await promisify(execFile)(COMBBENCH, ["export", "first-look", "--static", folder], { timeout: EXPORT_MS });
      const { server, address } = await host(folder);
      await use(address);
      server.close();
      rmSync(folder, { recursive: true });
    },
    { scope: "worker", timeout: EXPORT_MS },
  ],
  strayed: [
    async ({ page, address }, use) => {
      const found: string[] = [];
      page.on("request", (request) => {
        if (!request.url().startsWith(address) && !/^(data|blob):/.test(request.url())) found.push(request.url());
      });
      page.on("console", (message) => {
        if (message.type() === "error") found.push(message.text());
      });
      await use(found);
      expect(found, "requests that left the folder, and errors").toEqual([]);
    },
    { auto: true },
  ],
});

export { expect };
