import { expect, HYPOTHESES, test } from "./lab";
import { seriousViolations } from "./serious-violations";

const OTHERS = {
  "diagnosers.imm": { kind: "imm", hypotheses: HYPOTHESES },
  "diagnosers.lock_in": { kind: "lock_in", hypotheses: HYPOTHESES },
  "diagnosers.regions": { kind: "regions" },
};

test("diagnosers race on one axis: each with its delay, its place and its score", async ({ page, openBench }) => {
  await openBench("lecture", OTHERS);
  const kalman = page.getByRole("region", { name: "Diagnosis by kalman" });
  const imm = page.getByRole("region", { name: "Diagnosis by imm" });
  await expect(page.getByRole("img", { name: "The truth over time" })).toBeVisible();
  await expect(page.getByRole("region", { name: "Diagnosis by regions" })).toBeAttached();
  await page.getByRole("button", { name: /^Inject \+5.*Added mass$/ }).click();
  await expect(kalman.getByText(/^mass \+5\s%$/)).toBeVisible();
  await expect(imm.getByText(/^mass \+5\s%$/)).toBeVisible();
  await expect(page.getByText(/^[\d.]+\s[µm]s1st$/).first()).toBeVisible();
  await seriousViolations(page).then((found) => expect(found).toEqual([]));

  await page.getByRole("combobox", { name: "Diagnosers shown" }).selectOption("imm");
  await expect(page.getByRole("img", { name: /^Probability of healthy, mass \+5/ })).toBeVisible();
  await expect(kalman).toHaveCount(0);
});
