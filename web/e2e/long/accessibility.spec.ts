import { expect, test } from "../lab";
import { seriousViolations } from "../serious-violations";

test("axe finds nothing serious in any menu of a bench", async ({ page, openBench }) => {
  await openBench("lab");
  const menus = page.locator("[aria-haspopup=menu]:visible");
  const many = await menus.count();
  expect(many).toBeGreaterThan(4);
  for (let at = 0; at < many; at += 1) {
    await menus.nth(at).click();
    await expect(page.locator("[data-menu-dropdown] :is(input, [role=menuitem])").first()).toBeFocused();
    expect(await seriousViolations(page)).toEqual([]);
    await page.keyboard.press("Escape");
    await expect(page.getByRole("menu")).toHaveCount(0);
  }
});
