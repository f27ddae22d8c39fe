import { readFile } from "node:fs/promises";
import { expect, HYPOTHESES, pictureOf, test } from "./lab";
import { seriousViolations } from "./serious-violations";

const CANVAS = "section[aria-label='Behaviour'] canvas";

test("behaviours and regions are drawn, say what holds, and are kept as pictures", async ({ page, openBench }) => {
  await openBench("lab", {
    diagnosers: { consistency: { kind: "consistency", hypotheses: HYPOTHESES }, regions: { kind: "regions" } },
    events: [],
  });
  await page.getByRole("tab", { name: "Behaviour" }).click();
  const panel = page.getByRole("region", { name: "Behaviour" });
  const words = page.getByTestId("behaviour-words");
  await expect(words).toHaveText("Input and output belong to the behaviour: healthy. The verdict: no fault.");
  const healthy = await pictureOf(page, CANVAS);
  await page
    .getByRole("button", { name: /^Inject \+30/ })
    .first()
    .click();
  await expect(words).toHaveText(
    /^Input and output belong to the behaviour: damping \+30\s%\. The verdict: a fault is isolated\.$/,
  );
  await expect.poll(() => pictureOf(page, CANVAS)).not.toBe(healthy);

  const saved = page.waitForEvent("download");
  await panel.getByRole("button", { name: "Export" }).click();
  await page.getByRole("menuitem", { name: /SVG/ }).click();
  const svg = await readFile(await (await saved).path(), "utf8");
  expect(svg).toContain("output by its cosine, in limits");
  expect(svg).toContain("b+30");

  await panel.getByRole("combobox", { name: "Diagnoser drawn" }).selectOption("regions");
  await expect(words).toHaveText(
    /^Performance is degraded: 1[12]\.\d\s% from the healthy motion, at most 2\.\d+\sµm from rest\.$/,
  );
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
});
