import { expect, test } from "./lab";
import { seriousViolations } from "./serious-violations";

test("a hidden fault stays hidden until an answer is committed, then truth and points are shown", async ({
  page,
  openBench,
  server,
}) => {
  await openBench("lab");
  await page.getByRole("tab", { name: "Blind diagnosis" }).click();
  const panel = page.getByRole("region", { name: "Blind diagnosis" });
  await panel.getByRole("button", { name: "Hide a fault" }).click();
  const lanes = page.getByRole("region", { name: "Diagnosis by kalman" });
  await expect(lanes.getByText("hidden").first()).toBeVisible();
  await page.getByRole("tab", { name: "Faults" }).click();
  await expect(page.getByText("A fault may be hidden")).toBeVisible();
  await page.getByRole("tab", { name: "Blind diagnosis" }).click();

  await page.waitForTimeout(6000); // it comes within 8 ms of device time
  const other = await server.ask<{ id: string }>("POST", "/benches", { scenario: "ch5-seven-step" });
  await page.getByTitle(/: change bench$/).click();
  await page.getByRole("menuitem", { name: /^Seven-step f/ }).click();
  await expect(page).toHaveURL(new RegExp(other.id));
  await expect(lanes.getByText("hidden")).toHaveCount(0);
  await page.goBack();
  await expect(lanes.getByText("hidden").first()).toBeVisible();
  await server.ask("DELETE", `/benches/${other.id}`);
  const said = (await lanes.locator("dd").first().textContent()) ?? "";
  await panel.getByRole("radio", { name: said, exact: true }).check();
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
  await panel.getByRole("button", { name: "Commit the answer" }).click();
  await expect(panel.getByText(/^Right: it is .* 8\d points$|^Right: it is .* 9\d points$/)).toBeVisible();
  await expect(lanes.getByText("hidden")).toHaveCount(0);
  await expect(panel.getByRole("row")).toHaveCount(2);
  await panel.getByRole("button", { name: "Give up" }).waitFor({ state: "detached" });
});
