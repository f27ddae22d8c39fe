import { benchOf } from "../classroom";
import { expect, test } from "../lab";
import { seriousViolations } from "../serious-violations";

/** The titles of the bubbles of each tour. */
const TOURS: Record<string, string[]> = {
  "First look round": [
    "A bench that runs",
    "Run, step, pace",
    "The motion",
    "A fault",
    "The verdict",
    "Where to go next",
  ],
  Faults: ["The list of faults", "Damping +30 %", "Found", "Where it acts", "Heal all"],
  Controllers: ["A device that has changed", "Who drives", "MRAC drives", "What it learns", "Back to the open loop"],
  Diagnosis: ["Six hypotheses", "Mass +5 %", "Why", "The score", "Find one yourself"],
  "Runs and claims": [
    "From live to headless",
    "Runs and campaigns",
    "A run of its own",
    "Claim and measurement",
    "Back to the bench",
  ],
};

/** Bubbles that come once the fault of their tour has been found. */
const FINDINGS = ["The verdict", "Found", "Mass +5 %"];

test("every tour drives the page, does the described actions, and puts all back, at its end or by Escape", async ({
  page,
  openBench,
  server,
}) => {
  const runs = async () => (await server.rows("runs")).map(({ id }) => id);
  await server.ask("POST", "/runs", { scenario: "ch1-step" }); // as the tour's, and kept
  const ran = await runs();
  await openBench("research");
  const bench = benchOf(page);
  const tabs = () => page.getByRole("tab").allInnerTexts();
  const before = await tabs();
  const bubble = page.locator("#driver-popover-content");
  const asBefore = async () => {
    await expect(bubble).toHaveCount(0);
    await expect(page.getByTestId("bench-state")).toHaveText("running");
    await expect.poll(() => benchOf(page)).toBe(bench);
    await expect.poll(tabs).toEqual(before);
    await expect.poll(async () => (await server.rows("benches")).length).toBe(1);
  };
  const acting = async () => (await server.ask<{ faults: object[] }>("GET", `/benches/${benchOf(page)}`)).faults.length;
  const start = async (title: string) => {
    await page.keyboard.press("?");
    await page.getByRole("button", { name: title, exact: true }).click();
  };
  for (const [title, steps] of Object.entries(TOURS)) {
    await start(title);
    for (const [i, step] of steps.entries()) {
      if (FINDINGS.includes(step)) {
        await expect.poll(acting).toBe(1);
        await server.advance(3);
      }
      await expect(bubble).toContainText(step);
      await expect(bubble).toContainText(`${i + 1} of ${steps.length}`);
      if (step === "The verdict") {
        expect(benchOf(page)).not.toBe(bench);
        await expect(page.getByText("+5 %", { exact: false }).first()).toBeVisible();
        expect(await seriousViolations(page)).toEqual([]);
      }
      await bubble.getByRole("button", { name: i === steps.length - 1 ? "Done" : "Next" }).press("Enter");
    }
    await asBefore();
  }
  await start("Diagnosis");
  await expect(bubble).toContainText("Six hypotheses");
  await page.keyboard.press("Escape");
  await asBefore();
  expect(await runs()).toEqual(ran);

  await page.setViewportSize({ width: 390, height: 844 });
  await expect(page.getByRole("button", { name: "Take the tour" })).toHaveCount(0);
});
