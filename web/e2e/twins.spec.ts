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

test("gyroscopes are compared by the rate each reads, whichever of their loops differs", async ({
  page,
  openDocument,
  server,
}) => {
  await openDocument({
    title: "Gyroscope",
    device: { id: "gyro-c" },
    rate: { kind: "constant", deg_per_s: 100 },
    controller: { kind: "open_loop_rate" },
  });
  await page.getByRole("tab", { name: "Twins" }).click();
  await expect(page.getByRole("combobox", { name: "Controller of twin 1" })).toHaveValue("force_to_rebalance");
  await expect(page.getByRole("combobox", { name: "Controller of twin 2" })).toHaveValue("drive_tracking");
  await page.getByRole("button", { name: "Begin again with these" }).click();
  await page.getByRole("tab", { name: "Twins" }).click();
  const panel = page.locator("section[aria-label='Twins']");
  await expect(panel.getByRole("row")).toHaveCount(4);
  await expect(panel.getByRole("img", { name: /: rate, x, y, force along x, force along y over time$/ })).toBeVisible();
  await expect(panel.getByRole("row", { name: /^drive tracking/ })).toContainText(/\d\sdeg\/s.*N/);
  await server.ask("DELETE", `/benches/${new URL(page.url()).searchParams.get("bench")}`);
});
