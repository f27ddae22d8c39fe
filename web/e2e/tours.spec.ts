import { benchOf } from "./classroom";
import { expect, test } from "./lab";

test("a tour drives the page and puts all back at its end, and by Escape while its run is under way", async ({
  page,
  openBench,
  server,
}) => {
  await openBench("lecture");
  const bench = benchOf(page);
  const tabs = () => page.getByRole("tab").allInnerTexts();
  const before = await tabs();
  const bubble = page.locator("#driver-popover-content");
  const next = bubble.getByRole("button", { name: "Next" });
  const hints = page.getByRole("button", { name: "All hints" });
  const offer = page.getByRole("button", { name: "Take the tour" });
  const count = async (kind: "benches" | "runs") => (await server.rows(kind)).length;
  const asBefore = async () => {
    await expect(bubble).toHaveCount(0);
    await expect(page.getByTestId("bench-state")).toHaveText("running");
    await expect.poll(() => benchOf(page)).toBe(bench);
    await expect.poll(tabs).toEqual(before);
    await expect.poll(() => count("benches")).toBe(1);
  };
  await hints.click();
  await offer.click();
  for (const title of ["A bench that runs", "Run, step, pace", "The motion", "A fault"]) {
    await expect(bubble).toContainText(title);
    await next.press("Enter");
  }
  await expect(page.getByText(/^1\sactive fault$/)).toBeVisible();
  expect(benchOf(page)).not.toBe(bench);
  await server.advance(5);
  await expect(bubble).toContainText("The verdict");
  await expect(bubble).toContainText("5 of 6");
  await expect(page.getByText("+5 %", { exact: false }).first()).toBeVisible();
  await next.press("Enter");
  await expect(bubble).toContainText("Where to go next");
  await bubble.getByRole("button", { name: "Done" }).press("Enter");
  await asBefore();
  await hints.click();
  await expect(page.getByRole("region", { name: "Things to try" })).toBeVisible();
  await expect(offer).toHaveCount(0);
  await page.keyboard.press("Escape");

  await page.keyboard.press("?");
  await page.getByRole("button", { name: "Runs and claims", exact: true }).click();
  for (const title of ["From live to headless", "Runs and campaigns"]) {
    await expect(bubble).toContainText(title);
    await next.press("Enter");
  }
  await expect.poll(() => count("runs")).toBe(1);
  await page.keyboard.press("Escape");
  await asBefore();
  await expect.poll(() => count("runs")).toBe(0);
});
