import { expect, test } from "../folder-host";
import { openPanel, pictureOf, SCOPE_CANVAS } from "../lab";

test("in a folder the timeline goes back, a branch begins there, and the other future is drawn behind it", async ({
  page,
  address,
}) => {
  await page.goto(`${address}?layout=lab`);
  const state = page.getByTestId("bench-state");
  await expect(state).toHaveText("running");
  await page.getByRole("button", { name: /^Inject .* Added mass$/ }).click();
  await expect(page.getByText(/^1\sactive fault$/)).toBeVisible();
  const timeline = page.getByRole("region", { name: "Timeline" });
  const moment = timeline.getByRole("slider");
  await moment.focus();
  await page.keyboard.press("Home");
  await expect(timeline.getByText(/^As it was at/)).toBeVisible();
  await expect(page.getByText("The device is healthy")).toBeVisible();
  await timeline.getByRole("button", { name: "Back to now" }).click();
  await expect(page.getByText(/^1\sactive fault$/)).toBeVisible();
  await page.keyboard.press("Escape");
  await moment.focus();
  await page.keyboard.press("ArrowLeft");
  await expect(timeline.getByText(/^As it was at/)).toBeVisible();
  await timeline.getByRole("button", { name: "Branch here" }).click();
  await page.getByRole("menuitem", { name: "With PID" }).click();
  await expect(page.getByText(/^Behind, faded: First look/).first()).toBeVisible();
  await expect(state).toHaveText("running");
  await timeline.getByRole("button", { name: "The other future" }).click();
  await expect(state).toHaveText("running");
  await openPanel(page, "Log");
  await expect(page.getByText(/^inject added_mass/)).toBeVisible();
});

test("in a folder all panels of the menu show something, also after a visit before", async ({ page, address }) => {
  await page.goto(`${address}?layout=research`);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  const before = await pictureOf(page, SCOPE_CANVAS);
  await expect.poll(() => pictureOf(page, SCOPE_CANVAS)).not.toBe(before);
  await page.getByRole("button", { name: "Add or close panels" }).first().click();
  const titles = await page.getByRole("menuitem").allInnerTexts();
  const names = titles.map((text) => text.split("\n")[0]).filter((name) => !name.startsWith("Close "));
  expect(names).toEqual(["Loop", "Controller", "Faults", "Scope", "3D", "Diagnosis", "Compare", "Log"]);
  await page.keyboard.press("Escape");
  await page.reload();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await expect(page.getByText("Not without a server")).toHaveCount(0);
});
