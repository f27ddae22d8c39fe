import type { Page } from "@playwright/test";
import { expect, test } from "./lab";
import { seriousViolations } from "./serious-violations";

const lanesOf = (page: Page) => page.getByRole("region", { name: "Diagnosis by kalman" });
const whyOf = (page: Page) => page.getByRole("region", { name: "Why this sample" });

const SENTENCE = /^(healthy|[mkb]\+\d+) wins.* by [\d.]+ σ/;

/** Click one of the newest samples in the lanes. */
async function pick(page: Page): Promise<void> {
  const lanes = lanesOf(page);
  await expect(lanes.locator("dd").first()).toHaveText("healthy");
  const clock = page.getByRole("timer").locator("small");
  await expect.poll(async () => Number((await clock.innerText()).replaceAll(/\D/g, ""))).toBeGreaterThan(500);
  const field = await lanes.locator("canvas ~ div").last().boundingBox(); // without the names and figures beside it
  if (!field) throw new Error("the lanes are not drawn");
  await page.mouse.click(field.x + field.width - 14, field.y + 20);
}

/** Lanes and Why are both in sight, and neither lies over the other. */
async function besideEachOther(page: Page): Promise<void> {
  await expect(whyOf(page).getByText(SENTENCE)).toBeInViewport({ ratio: 1 });
  await expect(whyOf(page)).toBeInViewport({ ratio: 0.3 });
  await expect(lanesOf(page)).toBeInViewport({ ratio: 0.9 });
  const lanes = await lanesOf(page).boundingBox();
  const why = await whyOf(page).boundingBox();
  if (!lanes || !why) throw new Error("one of them is not drawn");
  const apart =
    lanes.x + lanes.width <= why.x ||
    why.x + why.width <= lanes.x ||
    lanes.y + lanes.height <= why.y ||
    why.y + why.height <= lanes.y;
  expect(apart).toBe(true);
}

test("a click on a sample shows the numbers behind it, and the next sample is one key away", async ({
  page,
  openBench,
}) => {
  await openBench("research");
  const why = whyOf(page);
  await pick(page);
  await expect(why.getByText(SENTENCE)).toBeVisible();
  await expect(why.getByRole("row")).toHaveCount(7);
  const healthy = why.getByRole("row", { name: /^healthy/ });
  await expect(healthy).toContainText("%");
  await expect(healthy).toContainText(/0\.\d+\s1\/ms/); // the gain of the velocity
  // the equations carry the numbers: a density, Bayes' rule, the floor, the correction by the gain
  await expect(why.getByRole("listitem")).toHaveCount(4);
  await why.getByRole("button", { name: "m+5" }).click();
  await expect(why.getByRole("heading", { name: /^m\+5 at this sample/ })).toBeVisible();

  const picked = Number(await why.getByRole("textbox", { name: "Sample" }).inputValue());
  await page.keyboard.press("w"); // the newest one
  const sample = async () => Number(await why.getByRole("textbox", { name: "Sample" }).inputValue());
  await expect.poll(sample).toBeGreaterThan(picked);
  const tick = await sample();
  await why.getByRole("button", { name: "Sample after" }).press("Enter");
  await expect(why.getByRole("textbox", { name: "Sample" })).toHaveValue(String(tick + 1));
  await seriousViolations(page).then((found) => expect(found).toEqual([]));

  await why.getByRole("textbox", { name: "Sample" }).fill("999999999");
  await why.getByRole("textbox", { name: "Sample" }).press("Enter");
  await expect(why.getByText(/^Sample 999999999 is not kept; the history has/)).toBeVisible();
  await why.getByRole("button", { name: "Explain the latest sample" }).click();
  await expect(healthy).toBeVisible();
  // the figures beside the lanes are those of the newest sample, and answer a click too
  const before = await sample();
  await page.getByRole("button", { name: "Explain the newest sample" }).click();
  await expect.poll(sample).toBeGreaterThan(before);
});

test("why opens beside the lanes in every layout, and goes to where the verdict turned", async ({
  page,
  openBench,
}) => {
  await page.setViewportSize({ width: 1366, height: 768 });
  await openBench("lecture");
  for (const key of ["1", "2", "3"]) {
    await page.keyboard.press(key);
    await pick(page);
    await besideEachOther(page);
  }
  // also where the lanes fill the page
  const group = page.locator(".dv-groupview", { has: lanesOf(page) });
  await group.getByRole("button", { name: "Fill the page with this panel" }).click();
  await pick(page);
  await besideEachOther(page);

  const faults = page.locator("section[aria-label='Faults']");
  await faults.getByRole("button", { name: /^Inject .*: Added mass$/ }).click();
  await expect(lanesOf(page).locator("dd").first()).toHaveText(/^mass \+5\s%$/);
  await page.getByRole("button", { name: "Pause" }).click();
  const why = whyOf(page);
  await why.getByRole("button", { name: "Latest" }).click();
  await expect(why.getByText(/^Mass \+5\s% (wins|stays ahead)/)).toBeVisible();
  const last = Number(await why.getByRole("textbox", { name: "Sample" }).inputValue());
  const turn = why.getByRole("button", { name: "The sample where it turned" });
  await turn.click();
  await expect(why.getByText(/The verdict turned at this sample, from /)).toBeVisible();
  await expect(why.getByText(/^Mass \+5\s% (wins|stays ahead)/)).toBeVisible();
  await expect(turn).toBeDisabled();
  expect(Number(await why.getByRole("textbox", { name: "Sample" }).inputValue())).toBeLessThan(last);
  await why.getByRole("textbox", { name: "Sample" }).fill("1");
  await why.getByRole("textbox", { name: "Sample" }).press("Enter");
  await expect(why.getByText(/The verdict has not turned since sample 0, the first one kept/)).toBeVisible();
  await expect(turn).toBeDisabled();
});

test.describe("in the hand", () => {
  test.use({ viewport: { width: 390, height: 844 } });

  test("why opens below the lanes, both in sight, and closes", async ({ page, openBench }) => {
    await openBench();
    await lanesOf(page).scrollIntoViewIfNeeded();
    await pick(page);
    await besideEachOther(page);
    await page.getByRole("button", { name: "Close Why" }).click();
    await expect(whyOf(page)).toBeHidden();
  });
});
