import type { Page } from "@playwright/test";
import { expect, test } from "../lab";
import { nameOf, SCREENS } from "../screens";

const PANELS = ["Knobs", "Drawing", "Figures", "Frequency response", "Sensitivity"];

/** Parts that are missing, stick out of their panel or of the page, or cover another panel. */
const faultsOf = (page: Page): Promise<string[]> =>
  page.locator("main").evaluate((main, wanted) => {
    const panels = Array.from(main.querySelectorAll("section, header")).map((panel) => {
      const box = panel.getBoundingClientRect();
      const isScrolled = /auto|scroll/.test(getComputedStyle(panel).overflowY);
      const beyond = Array.from(panel.querySelectorAll("*")).filter((part) => {
        const { width, height, left, right, top, bottom } = part.getBoundingClientRect();
        const isAcross = left < box.left - 1 || right > box.right + 1;
        const isDown = !isScrolled && (top < box.top - 1 || bottom > box.bottom + 1);
        return width > 0 && height > 0 && (isAcross || isDown);
      });
      return { name: panel.getAttribute("aria-label") ?? "top", box, beyond };
    });
    const missing = wanted.filter((name) => !panels.some((panel) => panel.name === name));
    const over = panels.flatMap((a, i) =>
      panels.slice(i + 1).flatMap((b) => {
        const across = Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left);
        const down = Math.min(a.box.bottom, b.box.bottom) - Math.max(a.box.top, b.box.top);
        return Math.min(across, down) > 0.5 ? [`${a.name} lies over ${b.name}`] : [];
      }),
    );
    const out = panels.flatMap(({ name, box, beyond }) => [
      ...beyond.map((part) => `${part.tagName} ${part.textContent?.slice(0, 40)} sticks out of ${name}`),
      ...(box.left < 0 || box.right > window.innerWidth ? [`${name} is cut`] : []),
    ]);
    return [...missing.map((name) => `${name} is missing`), ...over, ...out];
  }, PANELS);

test("no panel of the designer covers another or is cut, at any width", async ({ page, server }) => {
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?page=designer`);
  await expect(page.getByRole("img", { name: /^Bode diagram/ })).toBeVisible();
  for (const screen of SCREENS) {
    const at = nameOf(screen);
    await page.setViewportSize(screen);
    await expect.poll(() => faultsOf(page), at).toEqual([]);
    for (const name of PANELS) {
      const last = page.getByRole("region", { name }).locator(":scope > :last-child");
      await last.scrollIntoViewIfNeeded();
      await expect(last, `${at}: the end of ${name} can be reached`).toBeInViewport();
    }
    await page.evaluate(() => {
      for (const part of Array.from(document.querySelectorAll("main *"))) part.scrollTop = 0;
    });
  }
});
