import { expect, test } from "./lab";
import { seriousViolations } from "./serious-violations";

test("a list of hypotheses is edited, its aliases are seen, and the bench begins again with it", async ({
  page,
  openBench,
}) => {
  await openBench("lab");
  await page.getByRole("tab", { name: "Hypotheses" }).click();
  const panel = page.getByRole("region", { name: "Hypotheses" });
  await expect(panel.getByRole("textbox", { name: /^Name of hypothesis/ })).toHaveCount(6);
  await expect(panel.getByRole("img", { name: /in the complex plane/ })).toBeVisible();

  // 5 % more mass moves like 3.24 % less stiffness at 2 kHz: -(w/w0)^2 times as much
  const worth = await panel.getByText(/of mass moves like/).textContent();
  const share = Number(/like [−-](\d\.\d\d)\s%/.exec(worth ?? "")?.[1]);
  expect(share).toBeGreaterThan(0.5);
  await panel.getByRole("button", { name: "Hypothesis", exact: true }).click();
  const added = panel.getByRole("row").filter({ has: page.getByRole("textbox", { name: "Name of hypothesis 7" }) });
  await expect(page.getByRole("textbox", { name: "Name of hypothesis 7" })).toHaveValue("m+15");
  const fill = async (factor: string, percent: number) => {
    const field = added.getByRole("textbox", { name: new RegExp(`^${factor} of`) });
    await field.fill(String(percent));
    await field.press("Enter");
  };
  await fill("mass", 0);
  await fill("stiffness", -5 * share);
  await expect(panel.getByRole("row", { name: /aliases/ })).toContainText("m+5");

  await panel.getByRole("textbox", { name: "Name of hypothesis 7" }).fill("m+5");
  await expect(panel.getByRole("alert")).toHaveText("m+5 is there twice.");
  await panel.getByRole("textbox", { name: "Name of hypothesis 7" }).fill("soft");
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
  await panel.getByRole("button", { name: "Begin again with this list" }).click();
  await page.getByRole("tab", { name: "Diagnosis", exact: true }).click();
  await expect(page.getByRole("img", { name: /^Probability of .*, soft over time$/ })).toBeVisible();
});
