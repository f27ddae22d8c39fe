import { expect, test } from "./lab";
import { seriousViolations } from "./serious-violations";

test("twins begin from the page and meet the same fault under other controllers", async ({ page, openBench }) => {
  await openBench("lab");
  await page.getByRole("tab", { name: "Twins" }).click();
  await page.getByRole("combobox", { name: "Controller of twin 1" }).selectOption("mrac");
  await page.getByRole("combobox", { name: "Controller of twin 2" }).selectOption("stvsc");
  await page.getByRole("button", { name: "Begin again with these" }).click();

  const panel = page.getByRole("region", { name: "Twins" });
  await expect(panel.getByRole("row")).toHaveCount(4);
  await expect(
    panel.getByRole("img", { name: /^this bench, mrac, stvsc: displacement, effort, mrac: gain r/ }),
  ).toBeVisible();
  await page.getByRole("button", { name: /^Inject \+5.*Added mass$/ }).click();
  await expect(panel.getByRole("row", { name: /^mrac/ })).toContainText(/\d\s[nµ]m/);
  await seriousViolations(page).then((found) => expect(found).toEqual([]));

  await panel.getByRole("button", { name: "Leave out twin 2" }).click();
  await panel.getByRole("button", { name: "Leave out twin 1" }).click();
  await panel.getByRole("button", { name: "Begin again alone" }).click();
  await expect(page.getByText("No twins on this bench")).toBeVisible();
});
