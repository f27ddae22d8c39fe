import type { Page } from "@playwright/test";
import { expect, test } from "./lab";
import type { LabServer } from "./lab-server";
import { seriousViolations } from "./serious-violations";

const benchOf = (page: Page) => new URL(page.url()).searchParams.get("bench") ?? "";
const digestOf = (server: LabServer, page: Page) =>
  server.ask<{ tick: number; digest: string }>("GET", `/benches/${benchOf(page)}/digest`);

test("each browser has a bench of its own, and joins another by its link", async ({ browser, server }) => {
  const [mine, other] = await Promise.all([browser.newContext(), browser.newContext()]);
  const [page, visitor] = await Promise.all([mine.newPage(), other.newPage()]);
  for (const one of [page, visitor]) {
    await one.goto(server.url);
    await expect(one.getByTestId("bench-state")).toHaveText("running");
  }
  const own = benchOf(visitor);
  expect(benchOf(page)).not.toBe(own);
  await visitor.goto(page.url());
  await expect(visitor.getByText("2 watching")).toBeVisible();
  await page.getByRole("button", { name: "Pause" }).click();
  await expect(visitor.getByTestId("bench-state")).toHaveText("paused");
  await visitor.goto(server.origin); // its own is still its own
  await expect(visitor.getByTestId("bench-state")).toHaveText("running");
  expect(benchOf(visitor)).toBe(own);
  await mine.close();
  await other.close();
});

test("a link made in two clicks opens the same tick, log, layout, cursors and note elsewhere", async ({
  page,
  openBench,
  browser,
  server,
}) => {
  await openBench("lab");
  await server.ask("POST", `/benches/${benchOf(page)}/commands`, { fault: "added_mass", severity: 0.05 });
  await page.getByRole("button", { name: "Pause" }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await page.getByRole("tab", { name: "Events", exact: true }).click();
  await page.getByRole("button", { name: "Measure" }).first().click();
  const cursor = page.getByRole("slider", { name: "Cursor A" });
  await cursor.press("ArrowLeft");
  await cursor.press("ArrowLeft");
  await expect(cursor).toHaveAttribute("aria-valuenow", "23");

  await page.getByRole("button", { name: "Share this experiment" }).click();
  const link = page.getByRole("textbox", { name: "Link", exact: true });
  await expect(link).toHaveValue(new RegExp(`^${server.origin}/\\?link=[2-9a-z]{8}$`));
  const qr = page.getByRole("img", { name: /^QR code of/ });
  expect((await qr.boundingBox())?.width).toBeGreaterThanOrEqual(200);
  await expect(page.getByText("Other computers cannot reach this address")).toBeVisible();
  await page.getByLabel("Note").fill("Watch the mass.");
  expect(await seriousViolations(page)).toEqual([]);
  await page.getByRole("button", { name: "Copy", exact: true }).click();
  await expect(page.getByRole("button", { name: "Copied" })).toBeVisible();
  const address = await link.inputValue();

  const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
  const elsewhere = await context.newPage();
  await elsewhere.request.get(server.url);
  await elsewhere.goto(address);
  await expect(elsewhere.getByTestId("bench-state")).toHaveText("paused");
  expect(benchOf(elsewhere)).not.toBe(benchOf(page));
  expect(await digestOf(server, elsewhere)).toEqual(await digestOf(server, page));
  await expect(elsewhere.getByRole("region", { name: "Note of the link" })).toContainText("Watch the mass.");
  await expect(elsewhere.getByRole("tab", { name: "Events", exact: true })).toHaveAttribute("aria-selected", "true");
  const log = elsewhere.getByRole("list", { name: "Events, newest first" });
  await expect(log.getByText(/added.mass/i).first()).toBeVisible();
  await expect(elsewhere.getByRole("slider", { name: "Cursor A" })).toHaveAttribute("aria-valuenow", "23");
  await elsewhere.reload();
  await expect(elsewhere.getByRole("slider", { name: "Cursor A" })).toHaveAttribute("aria-valuenow", "23");
  await context.close();
});

test("a link that leads nowhere says so and leads on", async ({ page, server }) => {
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?link=nothere2`);
  await expect(page.getByText("there is no link 'nothere2'")).toBeVisible();
  await page.getByRole("button", { name: "Open my own bench" }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
});
