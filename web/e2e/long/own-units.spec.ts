import { readFileSync } from "node:fs";
import { join } from "node:path";
import { expect, test } from "../lab";
import { expectClean, SCREENS, showOn } from "../screens";

const DOCUMENT = readFileSync(join(import.meta.dirname, "..", "..", "..", "docs", "own-units.md"), "utf-8");
const [PI, JUDGE] = DOCUMENT.split("```python\n")
  .slice(1)
  .map((part) => part.split("```")[0]);

test("user units are on the page like the units of the library: chosen, tuned, explained, scored", async ({
  page,
  server,
  openDocument,
}) => {
  const id = await openDocument({
    schema: 1,
    id: "own",
    title: "Units of one's own",
    sample_rate_khz: 100,
    device: { id: "ch3", force_n_per_v: 6.375e-9, bias_v: 6.0 },
    sensor: { kind: "ideal", noise_um: 0.05 },
    diagnosers: { mine: { kind: "leaky_squares" } },
    units: { pi: { source: PI }, leaky_squares: { source: JUDGE } },
  });
  await expect(page.getByRole("button", { name: /^Diagnosis Leaky squares/ })).toBeVisible();
  await page
    .getByRole("combobox", { name: /^Controller/ })
    .first()
    .click();
  await page.getByRole("option", { name: /^PI\b/ }).click();
  const driving = async () => (await server.ask<{ controller: string }>("GET", `/benches/${id}`)).controller;
  await expect.poll(driving).toBe("pi");
  await page.getByRole("button", { name: /^Controller PI/ }).click();
  const card = page.getByRole("region", { name: /^Block/ });
  await expect(card.getByText(/^Proportional and integral control/)).toBeVisible();
  await expect(card.locator(".katex").first()).toBeVisible();
  await expect(card.getByLabel(/proportional/i).first()).toBeVisible();
  await page.getByRole("tab", { name: "Faults" }).click();
  await page.getByRole("button", { name: /^Inject .* Added mass$/ }).click();
  await expect(page.getByText(/^1\sactive fault$/)).toBeVisible();
  const says = page.getByRole("region", { name: "Diagnosis by mine" }).locator("dd").first();
  const later = async () => {
    await server.advance(1);
    return says.innerText();
  };
  await expect.poll(later).toMatch(/^mass \+5/);
  await expectClean(page, "a bench with units of one's own");
  await showOn(page, SCREENS[3]);
  await expectClean(page, "the same on a phone");
});
