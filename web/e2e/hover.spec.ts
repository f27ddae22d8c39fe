import type { Page } from "@playwright/test";
import { expect, test } from "./lab";
import { sceneAtRest, sceneOf, sceneShown } from "./scene";

test.use({ drawn: true });

/** The middle of the field of the first scope, and its ends. */
async function fieldOf(page: Page) {
  const box = await page
    .getByRole("region", { name: /^Scope: / })
    .first()
    .locator(".u-over")
    .boundingBox();
  if (!box) throw new Error("no scope is drawn");
  return { x: (share: number) => box.x + share * box.width, y: box.y + box.height / 2 };
}

test("under the pointer the device in 3D is that of the moment, and it comes back when the pointer leaves", async ({
  page,
  openBench,
  server,
}) => {
  await openBench("research");
  const bench = new URL(page.url()).searchParams.get("bench");
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  const caption = sceneOf(page).contentFrame().locator("#caption");
  const moment = caption.locator("b");
  await expect(caption).toContainText("motion ×", { timeout: 120_000 });
  await page.mouse.move(4, 4);
  const shown = () => sceneShown(page);
  const now = await sceneAtRest(page);
  await expect(moment).toBeHidden();

  const { x, y } = await fieldOf(page);
  await page.mouse.move(x(0.31), y);
  await expect(moment).toHaveText(/^at \d+\.\d{3}\sms$/, { timeout: 120_000 });
  const then = await sceneAtRest(page);
  expect(then).not.toBe(now);
  const first = await moment.textContent();
  await page.mouse.move(x(0.62), y);
  await expect(moment).not.toHaveText(first ?? "", { timeout: 120_000 });
  expect(await sceneAtRest(page)).not.toBe(then);
  await page.mouse.move(x(0.31), y);
  await expect(moment).toHaveText(first ?? "", { timeout: 120_000 });
  await expect.poll(shown, { timeout: 120_000, intervals: [500] }).toBe(then);

  await page.mouse.move(4, 4);
  await expect(moment).toBeHidden({ timeout: 120_000 });
  await expect.poll(shown, { timeout: 120_000, intervals: [500] }).toBe(now);

  // a fault that came later is not on the device of before, and is there again when the pointer leaves
  await server.ask("POST", `/benches/${bench}/commands`, { fault: "added_mass", severity: 0.3 });
  await server.ask("POST", `/benches/${bench}/commands`, { kind: "step", ticks: 3 });
  await expect.poll(shown, { timeout: 120_000, intervals: [500] }).not.toBe(now);
  await page.mouse.move(x(0.31), y);
  await expect(moment).toBeVisible({ timeout: 120_000 });
  await page.mouse.move(4, 4);
  await expect(moment).toBeHidden({ timeout: 120_000 });
});

test("the probability table follows a pointer that rests, and goes back to the sample that was chosen", async ({
  page,
  openBench,
}) => {
  await page.route("**/3d/", (route) => route.fulfill({ contentType: "text/html", body: "" }));
  await openBench("lab");
  await expect
    .poll(async () => Number((await page.getByText(/^tick/).first().textContent())?.replace(/\D/g, "")))
    .toBeGreaterThan(500);
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  await page.getByRole("button", { name: "Explain the newest sample" }).click();
  const why = page.getByRole("region", { name: "Why this sample" });
  const sample = why.getByRole("textbox", { name: "Sample", exact: true });
  await expect(why.getByRole("table")).toBeVisible();
  const chosen = await sample.inputValue();
  const { x, y } = await fieldOf(page);
  await page.mouse.move(x(0.4), y);
  await expect(sample).not.toHaveValue(chosen);
  const there = await sample.inputValue();
  expect(Number(there)).toBeLessThan(Number(chosen));
  await page.mouse.move(x(0.7), y);
  await expect.poll(async () => Number(await sample.inputValue())).toBeGreaterThan(Number(there));
  await page.mouse.move(4, 4);
  await expect(sample).toHaveValue(chosen);
});
