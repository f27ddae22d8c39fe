import { expect, test } from "./lab";
import { faintLetters, seriousViolations } from "./serious-violations";

test("keys alone reach the bench: each menu opens with its first item in focus and gives the focus back", async ({
  page,
  openBench,
}) => {
  await openBench("lab");
  const state = page.getByTestId("bench-state");
  await page.keyboard.press(" ");
  await expect(state).toHaveText("paused");
  await page.keyboard.press(" ");
  await expect(state).toHaveText("running");
  // more of them show while their group has the keyboard, so each is found again by its id
  const ids = await page
    .locator("[aria-haspopup=menu]:visible")
    .evaluateAll((buttons) => buttons.map((button) => button.id));
  expect(ids.length).toBeGreaterThan(4);
  for (const id of ids) {
    const menu = page.locator(`[id="${id}"]`);
    await menu.press("Enter");
    await expect(page.locator("[data-menu-dropdown] :is(input, [role=menuitem])").first()).toBeFocused();
    await page.keyboard.press("Escape");
    await expect(page.getByRole("menu")).toHaveCount(0);
    await expect(menu).toBeFocused();
  }
  await page.getByRole("button", { name: /^Inject .* Added mass$/ }).press("Enter");
  await expect(page.getByText(/^1\sactive fault$/)).toBeVisible();
  await page.getByRole("tab", { name: "Voltage" }).focus();
  await page.keyboard.press("?");
  await expect(page.getByRole("dialog", { name: "Keyboard" })).toBeVisible();
  await page.keyboard.press("Escape");
  await expect(page.getByRole("dialog")).toHaveCount(0);
  await expect(page.getByRole("tab", { name: "Voltage" })).toBeFocused();
});

test("axe finds nothing serious on a bench and on the pages around it, in the dark and in the light", async ({
  page,
  server,
  openBench,
}) => {
  const showIn = async (colorScheme: "dark" | "light") => {
    await page.emulateMedia({ colorScheme });
    await expect(page.locator("html")).toHaveAttribute("data-mantine-color-scheme", colorScheme);
  };
  // only the contrast of letters depends on the scheme
  const expectAccessible = async (where: string) => {
    await showIn("dark");
    expect(await seriousViolations(page), `${where}, dark`).toEqual([]);
    await showIn("light");
    expect(await faintLetters(page), `${where}, light`).toEqual([]);
  };
  await openBench("lab");
  await page.getByRole("button", { name: "Damping", exact: true }).click();
  await page.getByRole("button", { name: /^Inject .* Added mass$/ }).click();
  await expect(page.getByText(/^1\sactive fault$/)).toBeVisible();
  await server.advance(2);
  await expectAccessible("the bench");
  await page.getByRole("button", { name: /Diagnosis ?Kalman/ }).click();
  await page.keyboard.press("?");
  await expect(page.getByRole("dialog")).toBeVisible();
  await expectAccessible("a dialog");
  await page.goto(`${server.origin}/?page=gallery`);
  await expect(page.getByRole("heading", { name: "First look" })).toBeVisible();
  await expectAccessible("the gallery");
  await page.goto(`${server.origin}/?page=class`);
  await expect(page.getByRole("button", { name: "Open the class" })).toBeVisible();
  await expectAccessible("the page of classes");
  await page.goto(`${server.origin}/?page=runs`);
  await page.getByText("Campaign", { exact: true }).click();
  await expect(page.getByRole("button", { name: /^Start 1 run/ })).toBeVisible();
  await expectAccessible("the page of runs");
});
