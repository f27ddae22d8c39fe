import { expect, test } from "./lab";
import { seriousViolations } from "./serious-violations";

test("every menu of a bench opens with its first item in focus, and axe finds nothing serious in it", async ({
  page,
  openBench,
}) => {
  test.slow(); // each of ten menus is looked through by axe
  await openBench("lab");
  const menus = page.locator("[aria-haspopup=menu]:visible");
  const many = await menus.count();
  expect(many).toBeGreaterThan(4);
  for (let at = 0; at < many; at++) {
    await menus.nth(at).click();
    await expect(page.getByRole("menuitem").first()).toBeFocused();
    expect(await seriousViolations(page)).toEqual([]);
    await page.keyboard.press("Escape");
    await expect(page.getByRole("menu")).toHaveCount(0);
    await expect(menus.nth(at)).toBeFocused();
  }
});

for (const colorScheme of ["dark", "light"] as const) {
  test.describe(colorScheme, () => {
    test.use({ colorScheme });

    test(`axe finds nothing serious in ${colorScheme}`, async ({ page, openBench }) => {
      await openBench("lab");
      await page.getByRole("button", { name: "Damping", exact: true }).click();
      await page.getByRole("button", { name: /^Inject .* Added mass$/ }).click();
      await expect(page.getByText("1 fault acts")).toBeVisible();
      await seriousViolations(page).then((found) => expect(found).toEqual([]));
      await page.getByRole("button", { name: /Diagnosis ?Kalman/ }).click();
      await page.keyboard.press("?");
      await expect(page.getByRole("dialog")).toBeVisible();
      await seriousViolations(page).then((found) => expect(found).toEqual([]));
    });

    test(`axe finds nothing serious on the pages around the bench in ${colorScheme}`, async ({ page, server }) => {
      await page.request.get(server.url);
      await page.goto(`${server.origin}/?page=gallery`);
      await expect(page.getByRole("heading", { name: "First look" })).toBeVisible();
      await seriousViolations(page).then((found) => expect(found).toEqual([]));
      await page.goto(`${server.origin}/?page=class`);
      await expect(page.getByRole("button", { name: "Open the class" })).toBeVisible();
      await seriousViolations(page).then((found) => expect(found).toEqual([]));
      await page.goto(`${server.origin}/?page=runs`);
      await page.getByText("Campaign", { exact: true }).click();
      await expect(page.getByRole("button", { name: /^Start 1 run/ })).toBeVisible();
      await seriousViolations(page).then((found) => expect(found).toEqual([]));
    });
  });
}
