import { expect, test } from "./lab";
import { expectFits } from "./screens";

test("what is done to a bench or its panels is taken back by key, by button and in the notice, and made again", async ({
  page,
  openBench,
}) => {
  await openBench();
  const faults = page.getByRole("region", { name: "Faults" });
  const acting = faults.getByText("1 fault acts");
  await faults.getByRole("button", { name: /^Inject .*Added mass/ }).click();
  await expect(acting).toBeVisible();

  await page.getByRole("button", { name: /^Undo: Added mass \+5/ }).click();
  await expect(acting).toBeHidden();
  await page.locator("body").press("Control+y");
  await expect(acting).toBeVisible();

  await page.locator("body").press("h");
  await expect(acting).toBeHidden();
  await page.getByRole("alert").filter({ hasText: "All faults healed" }).getByRole("button", { name: "Undo" }).click();
  await expect(acting).toBeVisible();

  const close = async () => {
    await page.getByRole("button", { name: "Add or close panels" }).first().click();
    await page.getByRole("menuitem", { name: /^Close / }).click();
  };
  const panels = page.getByRole("tab");
  const before = await panels.count();
  await close();
  await expect(panels).toHaveCount(before - 1);
  await page.waitForTimeout(400); // a layout is one change once it has settled
  await page.locator("body").press("Control+z");
  await expect(panels).toHaveCount(before);
  await expect(acting).toBeVisible();
  await page.locator("body").press("Control+z");
  await expect(acting).toBeHidden();
});

test("a reset is taken back: the time, the fault and the trace are there again", async ({ page, openBench }) => {
  await openBench();
  const tick = async () => Number((await page.getByRole("timer").locator("small").textContent())?.replace(/\D/g, ""));
  await expect.poll(tick).toBeGreaterThan(200);
  await page.locator("body").press("Space");
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  const before = await page.evaluate(async () => {
    const id = new URLSearchParams(window.location.search).get("bench");
    return (await (await fetch(`./api/v1/benches/${id}`)).json()).tick as number;
  });
  await expect.poll(tick).toBe(before); // the clock follows a moment behind
  await page.locator("body").press("Shift+R");
  await expect.poll(tick).toBe(0);
  await page.getByRole("alert").filter({ hasText: "Reset to the start" }).getByRole("button", { name: "Undo" }).click();
  await expect.poll(tick).toBe(before);
});

test("values are kept as a set, compared, and put back in one tick", async ({ page, openBench }) => {
  await openBench();
  await page.getByRole("button", { name: /Sensor ?Ideal/ }).click();
  const card = page.getByRole("region", { name: /^Block/ });
  await card.getByRole("button", { name: "Sets…" }).click();
  const sets = page.getByRole("region", { name: "Parameter sets" });
  await sets.getByRole("textbox", { name: "Keep the values of now as" }).fill("as it came");
  await sets.getByRole("button", { name: "Keep", exact: true }).click();
  await expect(sets.getByText("as it came")).toBeVisible();

  await page.getByRole("tab", { name: "Block" }).click();
  const noise = page.getByRole("textbox", { name: /^Noise, µm/ });
  await noise.fill("0.2");
  await noise.press("Enter");
  await page.getByRole("tab", { name: "Parameter sets" }).click();
  await sets.getByRole("button", { name: "Compare as it came" }).click();
  await expect(sets.getByRole("row", { name: /Noise.*50.nm.*200.nm/ })).toBeVisible();
  await sets.getByRole("button", { name: "Put as it came on the bench" }).click();
  await expect(sets.getByText(/^No difference in/)).toBeVisible();
  await expectFits(page, "parameter sets", undefined, "sets");

  await sets.getByRole("textbox", { name: "Keep the values of now as" }).fill("as it came");
  await sets.getByRole("button", { name: "Keep", exact: true }).click();
  await expect(page.getByRole("alert").filter({ hasText: "there is a set named" })).toBeVisible();
});
