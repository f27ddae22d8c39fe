import { expect, test } from "./lab";
import { seriousViolations } from "./serious-violations";

test("a typed transfer function is judged, an input is weighed, and the MIT rule has its map", async ({
  page,
  openBench,
}) => {
  await openBench();
  await page.keyboard.press("t");
  const real = page.getByRole("region", { name: "Positive real" });
  const typed = real.getByRole("textbox", { name: "G(s)" });
  await expect(real.getByText("Strictly positive real", { exact: true })).toBeVisible();
  // no resonator of relative degree two is positive real
  await typed.fill("1/(s^2 + 0.2s + 1)");
  await expect(real.getByText("Not positive real", { exact: true })).toBeVisible();
  await typed.fill("1/(s^2 + 0.2s + 1");
  await expect(real.getByText("a bracket is not closed")).toBeVisible();
  await typed.fill("1/s");
  await expect(real.getByText("Positive real, but not strictly", { exact: true })).toBeVisible();
  await expect(real.getByRole("img", { name: /^Real part over frequency/ })).toBeVisible();

  const excitation = page.getByRole("region", { name: "Persistent excitation" });
  await excitation.getByRole("button", { name: "One tone" }).click();
  await expect(excitation.getByText(/^Not persistently exciting/)).toBeVisible();
  await excitation.getByRole("button", { name: "Four tones" }).click();
  await expect(excitation.getByText(/^Persistently exciting/)).toBeVisible();

  const map = page.getByRole("region", { name: "Instability map" });
  await expect(
    map.getByRole("img", { name: /^MIT rule: growth over frequency and gain; \d+ % unstable/ }),
  ).toBeVisible();
  await expect(map.getByText(/Under a constant input the rule is unstable at gains above 0\.2\./)).toBeVisible(); // b1/b2 over the gains

  const index = page.getByRole("region", { name: "Equations" });
  await expect(index.getByRole("status")).toHaveText(/^\d{3}\sequations, \d{2,} of them with errata$/);
  await expect(index.getByRole("listitem").first()).toBeVisible();
  await index.getByRole("switch", { name: "Errata only" }).click();
  await expect(index.getByRole("status")).toHaveText(/^\d{2,}\sequations with errata$/);
  await index.getByRole("textbox", { name: "Search equations" }).fill("consistency behaviour 5.1.3");
  await expect(index.getByRole("listitem")).toHaveCount(1);
  await expect(index.getByText("the same input gives many outputs")).toBeVisible();
  await index.getByRole("textbox", { name: "Search equations" }).fill("nowhere to be found");
  await expect(index.getByText("No equation has all these words.")).toBeVisible();
  await index.getByRole("textbox", { name: "Search equations" }).fill("");
  await seriousViolations(page).then((found) => expect(found).toEqual([]));

  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "Bench", exact: true }).click();
  await expect(page.getByRole("region", { name: /^Scope/ }).first()).toBeVisible();
});
