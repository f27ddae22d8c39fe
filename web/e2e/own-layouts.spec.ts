import { expect, test } from "./lab";
import { seriousViolations } from "./serious-violations";

test("a panel is closed at its tab and comes back in its place", async ({ page, openBench }) => {
  await openBench("lab");
  const tabs = page.getByRole("tab");
  const named = (name: string) => page.getByRole("tab", { name, exact: true });
  const before = await tabs.allTextContents();
  const place = await named("Voltage").boundingBox();

  await named("Voltage").locator(".dock-close").click(); // alone in its group, which goes with it
  await expect(named("Voltage")).toHaveCount(0);
  await expect(page.getByText("Voltage closed.")).toBeVisible();
  await page.getByRole("alert").getByRole("button", { name: "Undo" }).click();
  await expect.poll(() => tabs.allTextContents()).toEqual(before);
  await expect.poll(async () => (await named("Voltage").boundingBox())?.y).toBeCloseTo(place?.y ?? 0, -1);

  await named("Events").click();
  const cross = await named("Events").locator(".dock-close").boundingBox();
  expect([cross?.width, cross?.height]).toEqual([24, 24]);
  await named("Events").focus();
  await page.keyboard.press("Delete");
  await expect(named("Events")).toHaveCount(0);
  await expect(page.locator("[role=tab]:focus")).toHaveAttribute("aria-selected", "true");
  await named("Environment").click(); // something else has changed meanwhile
  await page.getByRole("alert").getByRole("button", { name: "Undo" }).click();
  await expect(named("Events")).toHaveAttribute("aria-selected", "true");
  expect((await tabs.allTextContents()).sort()).toEqual(before.sort());
});

test("a layout is saved, renamed, shared and deleted; a built-in one is reset", async ({
  page,
  openBench,
  browser,
  server,
}) => {
  await openBench("lab");
  const named = (name: string) => page.getByRole("tab", { name, exact: true });
  const menu = async (item: string) => {
    await page.getByRole("button", { name: "Layout", exact: true }).click();
    await page.getByRole("menuitem", { name: item }).click();
  };
  const sheet = page.getByRole("dialog", { name: "Layouts" });
  await named("Voltage").locator(".dock-close").click();
  await menu("Save, rename or share");
  await sheet.getByRole("button", { name: "Save" }).click();
  await expect(sheet.getByText("Give it a name.")).toBeVisible();
  await sheet.getByLabel("Save the panels as they stand").fill("Lab");
  await sheet.getByRole("button", { name: "Save" }).click();
  await expect(sheet.getByText("There is a layout of this name.")).toBeVisible();
  await sheet.getByLabel("Save the panels as they stand").fill("No volts");
  await sheet.getByRole("button", { name: "Save" }).click();
  await sheet.getByRole("button", { name: "Rename No volts" }).click();
  await sheet.getByLabel("New name of No volts").fill("Motion alone");
  await sheet.getByLabel("New name of No volts").press("Enter");
  await sheet.getByRole("button", { name: "Make a link of the Motion alone layout" }).click();
  const address = await sheet.getByLabel("Link of the layout").inputValue();
  expect(address).toMatch(/\?layout=[2-9a-z]{8}$/);
  expect(await seriousViolations(page)).toEqual([]);
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

  const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
  const elsewhere = await context.newPage();
  await elsewhere.request.get(server.url);
  await elsewhere.goto(address);
  await expect(elsewhere.getByRole("tab", { name: "Displacement", exact: true })).toBeVisible();
  await elsewhere.getByRole("button", { name: "Layout", exact: true }).click();
  await expect(elsewhere.getByRole("menuitem", { name: "Motion alone" })).toHaveAttribute("aria-current", "true");
  await expect(elsewhere.getByRole("tab", { name: "Voltage", exact: true })).toHaveCount(0);
  await context.close();

  page.on("dialog", (question) => question.accept());
  await menu("Save, rename or share");
  await sheet.getByRole("button", { name: "Delete Motion alone" }).click();
  await expect(sheet.getByText("Motion alone")).toHaveCount(0);
  await expect(named("Voltage")).toBeVisible();
});
