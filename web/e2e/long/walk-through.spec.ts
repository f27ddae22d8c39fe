import { readFileSync } from "node:fs";
import { join } from "node:path";
import type { Locator, Page } from "@playwright/test";
import { benchOf } from "../classroom";
import { expect, test } from "../lab";
import { sceneOf, WEBGL_BROWSER } from "../scene";

const DOCS = join(import.meta.dirname, "..", "..", "..", "docs");
const TEXT = readFileSync(join(DOCS, "walk-through.md"), "utf8");
const HEADINGS = [...TEXT.matchAll(/^## (.*)$/gm)].map(([, heading]) => heading);

test.use({
  viewport: { width: 1366, height: 768 },
  colorScheme: "light",
  ...(process.env.PICTURES ? WEBGL_BROWSER : {}),
});

test("the walk-through of the documents can be walked, in as many clicks as it says", async ({
  page,
  server,
}, info) => {
  const walked: string[] = [];
  let clicks = 0;
  const click = async (what: Locator) => {
    await what.click();
    clicks += 1;
  };
  /** A part of the text, its picture, and its clicks. */
  const part = async (heading: string, picture: string, most: number, walk: () => Promise<void>) => {
    clicks = 0;
    await walk();
    expect(clicks, heading).toBe(most);
    walked.push(heading);
    expect(TEXT).toContain(`pictures/${picture}.jpg`);
    if (process.env.PICTURES) {
      await expect(page.locator(".mantine-Notification-root")).toHaveCount(0);
      for (const passing of ["The 3D view is loading", "display lagging", "– RMS"])
        await expect(page.getByText(passing)).toHaveCount(0);
    }
    // `SUITE=all PICTURES=docs npm run e2e -- walk-through` takes the pictures of the documents anew
    const path = process.env.PICTURES ? join(DOCS, "pictures", `${picture}.jpg`) : info.outputPath(`${picture}.jpg`);
    await page.screenshot({ path, type: "jpeg", quality: 82 });
  };
  const button = (name: string | RegExp) => page.getByRole("button", { name }).first();
  const traces = (within: Page | Locator) =>
    within
      .getByText(/\d\s(µm|nm)$/)
      .filter({ visible: true })
      .first();
  const benches: string[] = [];

  await part("The first page", "first-page", 0, async () => {
    await page.goto(server.url);
    await expect(page.getByTestId("bench-state")).toHaveText("running");
    benches.push(benchOf(page));
    await server.advanceTicks(benches[0], 801);
    await expect(traces(page)).toBeVisible();
    if (process.env.PICTURES) await expect(sceneOf(page).contentFrame().locator("#caption")).toContainText("motion ×");
  });
  await part("Inject a fault", "fault", 1, async () => {
    await click(button(/^Inject \+5.*Added mass$/));
    await expect(page.getByText(/^1\sactive fault$/)).toBeVisible();
    await server.advanceTicks(benches[0], 1000);
    await expect(page.getByText(/^\d+\ssamples · [1-9]\d{0,2}(\.\d+)?\s(µs|ms)$/).first()).toBeVisible();
  });
  await part("Ask why", "why", 0, async () => {
    await page.keyboard.press("w");
    await expect(page.getByRole("region", { name: "Why" }).getByText(/wins/).first()).toBeVisible();
  });
  await part("Share your experiment", "share", 2, async () => {
    await click(button("More"));
    await click(page.getByRole("menuitem", { name: /^Share this experiment/ }));
    await expect(page.getByRole("img", { name: /^QR code of/ })).toBeVisible();
  });
  await page.keyboard.press("Escape");
  await part("Look for a hidden fault", "hidden-fault", 3, async () => {
    await click(button("All hints"));
    await click(button("Find a hidden fault"));
    await click(button("Hide a fault"));
    await expect(page.getByText(/hidden until you answer/).first()).toBeVisible();
  });
  await page.getByRole("button", { name: "Give up" }).click();
  await expect(page.getByText(/hidden until you answer/)).toHaveCount(0);
  await page.keyboard.press("Shift+R"); // the revealed fault comes no more
  await part("Run the seven steps", "seven-steps", 1, async () => {
    await click(button("Run the seven steps"));
    const steps = page.getByRole("region", { name: "Steps of the scenario" });
    await expect.poll(() => benchOf(page)).not.toBe(benches[0]);
    benches.push(benchOf(page));
    await server.advance(0.01); // its quiet beginning has run by itself
    const { tick } = await server.ask<{ tick: number }>("GET", `/benches/${benches[1]}`);
    await server.advanceTicks(benches[1], 2500 - tick);
    await expect(steps).toContainText(/3 of 7/);
  });
  await part("Compare with the published figures", "gallery", 1, async () => {
    await click(page.getByRole("navigation").getByRole("button", { name: "Gallery" }));
    await expect(page.getByRole("list", { name: "Experiments" }).getByRole("listitem").nth(20)).toBeAttached();
    if (process.env.PICTURES) await expect(page.getByRole("img", { name: /^Figure of/ }).nth(5)).toBeVisible();
  });
  expect(walked).toEqual(HEADINGS);
  for (const bench of benches) await server.ask("DELETE", `/benches/${bench}`);
});
