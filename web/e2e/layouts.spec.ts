import { chooseMore, expect, front, test } from "./lab";

test("panels close at their tabs and come back; a layout is saved, renamed, deleted, reset, and stays with the page", async ({
  page,
  openBench,
}) => {
  await openBench("lab");
  page.on("dialog", (question) => question.accept());
  const tabs = page.getByRole("tab");
  const named = (name: string) => page.getByRole("tab", { name, exact: true });
  const undo = page.getByRole("alert").getByRole("button", { name: "Undo" });
  const before = await tabs.allTextContents();

  await front(page, "Voltage");
  await named("Voltage").locator(".dock-close").click();
  await expect(named("Voltage")).toHaveCount(0);
  await undo.click();
  await expect.poll(() => tabs.allTextContents()).toEqual(before);
  await front(page, "Log", "Events");
  await named("Log").focus();
  await page.keyboard.press("Delete");
  await expect(named("Log")).toHaveCount(0);
  await expect(page.locator("[role=tab]:focus")).toHaveAttribute("aria-selected", "true");
  await named("Device").click(); // another change comes between
  await undo.click();
  await expect(named("Log")).toHaveAttribute("aria-selected", "true");
  await expect(page.getByRole("list", { name: "Events, newest first" })).toBeVisible();
  await expect.poll(async () => (await tabs.allTextContents()).sort()).toEqual(before.sort());

  const menu = (item: string) => chooseMore(page, item);
  const sheet = page.getByRole("dialog", { name: "Layouts" });
  await front(page, "Voltage");
  await named("Voltage").locator(".dock-close").click();
  await menu("Save, rename or share");
  const name = sheet.getByLabel("Save this layout");
  await sheet.getByRole("button", { name: "Save" }).click();
  await expect(sheet.getByText("Give it a name.")).toBeVisible();
  await name.fill("Lab");
  await sheet.getByRole("button", { name: "Save" }).click();
  await expect(sheet.getByText("There is a layout of this name.")).toBeVisible();
  await name.fill("No volts");
  await sheet.getByRole("button", { name: "Save" }).click();
  await sheet.getByRole("button", { name: "Rename No volts" }).click();
  await sheet.getByLabel("New name of No volts").fill("Motion alone");
  await sheet.getByLabel("New name of No volts").press("Enter");
  await expect(sheet.getByRole("button", { name: "Rename Motion alone" })).toBeVisible();
  await sheet.getByRole("button", { name: "Close" }).click();

  await menu("Lab layout"); // as it was left, then as it was at first
  await expect(named("Voltage")).toHaveCount(0);
  await menu("Reset the lab layout");
  await expect(named("Voltage")).toBeVisible();
  await menu("Motion alone");
  await expect(named("Voltage")).toHaveCount(0);
  await page.reload();
  await expect(named("Displacement")).toBeVisible();
  await expect(named("Voltage")).toHaveCount(0);
  await menu("Save, rename or share");
  await sheet.getByRole("button", { name: "Delete Motion alone" }).click();
  await expect(sheet.getByText("Motion alone")).toHaveCount(0);
  await expect(named("Voltage")).toBeVisible();
});

test("panels keep their sizes, and the open tab is in view, when the page opens again", async ({ page, openBench }) => {
  await openBench("lab");
  const sizes = () =>
    page.locator(".dv-groupview").evaluateAll((groups) => groups.map((g) => [g.clientWidth, g.clientHeight]));
  const open = page.getByRole("tab", { name: "Published" });
  await open.click();
  const notice = page.getByRole("region", { name: "Try this" });
  await expect(notice).toBeVisible();
  const before = await sizes();
  for (const tab of ["Log", "Diagnosis"]) {
    await page.reload();
    await expect(open).toBeInViewport({ ratio: 1 });
    await expect(notice).toBeVisible();
    await page.getByRole("tab", { name: tab, exact: true }).click(); // stores the layout again
  }
  await expect.poll(sizes).toEqual(before);
});
