import { test as base, expect, type Page } from "@playwright/test";
import { LabServer } from "./lab-server";

interface LabFixtures {
  /** Open a fresh bench of the first-look scenario in a layout; it is closed after the test. */
  openBench(layout?: "lecture" | "lab" | "research"): Promise<void>;
}

/** Tests against a real server, with a bench of their own. */
export const test = base.extend<LabFixtures, { server: LabServer }>({
  server: [
    // biome-ignore lint/correctness/noEmptyPattern: the fixture depends on no other
    async ({}, use) => {
      const server = await LabServer.create();
      await use(server);
      await server.destroy();
    },
    { scope: "worker", timeout: 150_000 },
  ],
  openBench: async ({ page, server }, use) => {
    const opened: string[] = [];
    await use(async (layout = "lab") => {
      await page.request.get(server.url);
      const { id } = await server.ask<{ id: string }>("POST", "/benches", { scenario: "first-look" });
      opened.push(id);
      await page.goto(`${server.origin}/?bench=${id}&layout=${layout}`);
      await expect(page.getByTestId("bench-state")).toHaveText("running");
    });
    for (const id of opened) await server.ask("DELETE", `/benches/${id}`);
  },
});

export { expect };

/** What a canvas shows, as text that can be compared. */
export const pictureOf = (page: Page, selector: string): Promise<string> =>
  page
    .locator(selector)
    .first()
    .evaluate((canvas) => (canvas as HTMLCanvasElement).toDataURL());

export const SCOPE_CANVAS = "section[aria-label^='Scope'] canvas";
