import { expect, test } from "./folder-host";

test("a bench in a folder, without a server: a fault is injected, the bank finds it, and it is healed", async ({
  page,
  address,
}) => {
  await page.goto(`${address}?layout=lab`);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await expect(page.getByText("This page computes the bench itself.")).toBeVisible();
  await page.getByRole("button", { name: /^Inject .* Added mass$/ }).click();
  await expect(page.getByText(/^1\sactive fault$/)).toBeVisible();
  const tab = page.getByRole("tab", { name: "Diagnosis" });
  await tab.click();
  await expect(page.locator("[data-right=true]").getByText(/^mass \+5\s%$/)).toBeVisible();
  await page.getByRole("button", { name: /^Heal/ }).first().click();
  await expect(page.getByText("The device is healthy")).toBeVisible();
  await expect(page.getByRole("navigation", { name: "Pages" })).toHaveCount(0);
});
