import { test as base, expect, type Locator, type Page } from "@playwright/test";
import { LabServer } from "./lab-server";

interface LabFixtures {
  /** Whether the device is drawn in 3D: done in software, it takes half of the machine. */
  drawn: boolean;
  /** Closes the objects of a test, so that the next test finds the server empty. */
  tidy: undefined;
  /** Open a fresh bench of the first-look scenario in a layout, with values written over; closed after the test. */
  openBench(layout?: "lecture" | "lab" | "research", set?: Record<string, unknown>): Promise<void>;
  /** Open a fresh bench of a document in the lab layout; closed after the test. Its id. */
  openDocument(scenario: Record<string, unknown>): Promise<string>;
}

/** Tests against a real server, with a bench of their own. */
export const test = base.extend<LabFixtures, { server: LabServer }>({
  server: [
    // biome-ignore lint/correctness/noEmptyPattern: the fixture depends on no other
    async ({}, use) => {
      // the pictures of the documents show the gallery as it is after its figures have been made
      // canvases are drawn in software: each picture of the traces costs as much as a step of a test
      const server = await LabServer.create(
        process.env.PICTURES
          ? { COMBBENCH_FIGURES: "true" }
          : {
              COMBBENCH_FRAME_RATE_HZ: process.env.FRAME_RATE_HZ ?? "8",
              COMBBENCH_CLOCK: process.env.CLOCK ?? "manual",
            },
      );
      await use(server);
      await server.destroy();
    },
    { scope: "worker", timeout: 150_000 },
  ],
  drawn: [Boolean(process.env.PICTURES), { option: true }],
  page: async ({ page, drawn }, use) => {
    if (!drawn) await withoutScene(page);
    const refused: string[] = [];
    page.on("console", (message) => {
      const text = message.text();
      if (text.includes("Content Security Policy") && !text.includes("frame-ancestors")) refused.push(text);
    });
    await use(page);
    expect(refused, "what the content policy refuses").toEqual([]);
  },
  tidy: [
    async ({ server }, use, test) => {
      await use(undefined);
      if (test.status !== test.expectedStatus) for (const line of server.warnings) console.log(`server said: ${line}`);
      await server.clear();
    },
    { auto: true },
  ],
  openBench: async ({ page, server }, use) => {
    await use(async (layout = "lab", set = {}) => {
      await open(page, server, { scenario: "first-look", set }, layout);
    });
  },
  openDocument: async ({ page, server }, use) => {
    await use((scenario) => open(page, server, { scenario }, "lab"));
  },
});

async function open(page: Page, server: LabServer, bench: object, layout: string): Promise<string> {
  await page.request.get(server.url);
  const { id } = await server.ask<{ id: string }>("POST", "/benches", bench);
  await page.goto(`${server.origin}/?bench=${id}&layout=${layout}`);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  return id;
}

export { expect };

/** Bring a panel of the dock to the front, turned to one of its views. */
export async function front(page: Page, panel: string, view?: string): Promise<void> {
  const tab = page.getByRole("tab", { name: panel, exact: true });
  await tab.click();
  await expect(tab).toHaveAttribute("aria-selected", "true");
  if (!view) return;
  await page.getByRole("button", { name: new RegExp(`^Views of ${panel}: `) }).click();
  await page.getByRole("menuitem", { name: view, exact: true }).click();
}

/** Find a panel, a view or a scope in the menu of panels, and open the first that is found. */
export async function openPanel(page: Page, words: string): Promise<void> {
  await page.locator(".dv-active-group").getByRole("button", { name: "Add or close panels" }).click();
  await page.getByRole("searchbox", { name: /^Search panels/ }).fill(words);
  await page.keyboard.press("Enter");
  await expect(page.getByRole("menu")).toHaveCount(0);
}

/** Do something of the menu of all that is not about running. */
export async function chooseMore(page: Page, name: string | RegExp): Promise<void> {
  await page.getByRole("button", { name: "More", exact: true }).click();
  await page.getByRole("menuitem", { name }).click();
}

/** Leave the 3D view of a page empty. */
export const withoutScene = (page: Page): Promise<unknown> =>
  page.route(/\/3d\/(\?|$)/, (route) => route.fulfill({ contentType: "text/html", body: "" }));

/** The content of a canvas, as text for comparisons. */
export const pictureOf = (page: Page, selector: string): Promise<string> =>
  page
    .locator(selector)
    .first()
    .evaluate((canvas) => (canvas as HTMLCanvasElement).toDataURL());

/** Where a link leads. */
export const addressOf = (link: Locator): Promise<string> => link.evaluate((a) => (a as HTMLAnchorElement).href);

export const SCOPE_CANVAS = "section[aria-label^='Scope'] canvas";

/** The six hypotheses of the first look. */
export const HYPOTHESES = [
  { name: "healthy" },
  { name: "m+5", mass: 1.05 },
  { name: "m+10", mass: 1.1 },
  { name: "k+5", stiffness: 1.05 },
  { name: "k+10", stiffness: 1.1 },
  { name: "b+30", damping: 1.3 },
];

const FACTORS: Record<string, string> = { m: "mass", k: "stiffness", b: "damping" };

/** The page's name of a hypothesis: "m+5" is "mass +5 %". */
export const inWords = (name: string): string =>
  name.replace(/^([mkb])\+(\d+)$/, (_, factor, percent) => `${FACTORS[factor]} +${percent}\u00a0%`);

/** Choose a tool of a scope: its trigger, or its cursors. */
export async function chooseTool(scope: Locator, name: RegExp): Promise<void> {
  await scope.getByRole("button", { name: "Tools", exact: true }).click();
  await scope.page().getByRole("menuitem", { name }).click();
}
