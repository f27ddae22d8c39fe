import { expect, pictureOf, test } from "./lab";
import { seriousViolations } from "./serious-violations";

test("gains run beside their ideal values, and the meter says whether the input tells them apart", async ({
  page,
  openBench,
}) => {
  await openBench("lab");
  await page.getByRole("tab", { name: "Adaptation" }).click();
  const panel = page.getByRole("region", { name: "Adaptation" });
  await panel.getByRole("combobox", { name: "What adapts" }).selectOption("mrac");
  const strips = panel.getByRole("img", { name: /^mrac: gain r, .*V, dV\/dt by theory, error, augmented error/ });
  await expect(strips).toBeVisible();
  const before = await pictureOf(page, "section[aria-label='Adaptation'] canvas");
  await expect.poll(() => pictureOf(page, "section[aria-label='Adaptation'] canvas")).not.toBe(before);

  await panel.getByRole("button", { name: "Give it the drive" }).click();
  await expect(panel.getByRole("combobox", { name: "What adapts" })).toContainText("mrac, drives");
  await expect(panel.getByText(/runs in shadow/)).toHaveCount(0);

  // a bench of its own with the monitor; what was set live is kept
  await panel.getByRole("button", { name: "Begin again with an excitation monitor" }).click();
  await expect(panel.getByText(/tells? (them|all) .*apart|cannot be told apart/)).toBeVisible();
  await expect(page.getByRole("combobox", { name: "Controller", exact: true })).toHaveValue("Direct MRAC");
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
});
