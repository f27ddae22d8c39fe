import { expect, test } from "./lab";

const SIZES = [
  { width: 1366, height: 768 },
  { width: 1920, height: 1080 },
  { width: 820, height: 1180 },
  { width: 390, height: 844 },
];
const PANELS = ["What can be turned", "Drawing", "Figures", "Frequency response", "Sensitivity"];

test("no panel of the designer lies over another or is cut, at any width", async ({ page, openBench, server }) => {
  await openBench();
  const bench = new URL(page.url()).searchParams.get("bench");
  await page.goto(`${server.origin}/?bench=${bench}&page=designer`);
  for (const size of SIZES) {
    const at = `${size.width}x${size.height}`;
    await page.setViewportSize(size);
    await page.evaluate(() => {
      for (const part of Array.from(document.querySelectorAll("main *"))) part.scrollTop = 0;
    });
    await expect(page.getByRole("img", { name: /^Bode diagram/ })).toBeVisible();
    // the page is laid out anew in its own time
    await expect(async () => {
      const panels = await page.locator("main").evaluate((main) =>
        Array.from(main.querySelectorAll("section, header")).map((panel) => {
          const { left, top, right, bottom } = panel.getBoundingClientRect();
          const isScrolled = /auto|scroll/.test(getComputedStyle(panel).overflowY);
          const beyond = Array.from(panel.querySelectorAll("*")).flatMap((part) => {
            const box = part.getBoundingClientRect();
            const isBeyond =
              box.width > 0 &&
              box.height > 0 &&
              (box.left < left - 1 ||
                box.right > right + 1 ||
                (!isScrolled && (box.top < top - 1 || box.bottom > bottom + 1)));
            return isBeyond
              ? [`${part.tagName} ${part.getAttribute("aria-label") ?? part.textContent?.slice(0, 40)}`]
              : [];
          });
          return { name: panel.getAttribute("aria-label") ?? "top", left, top, right, bottom, beyond };
        }),
      );
      expect(panels.map(({ name }) => name).sort(), at).toEqual([...PANELS, "top"].sort());
      for (const { name, left, right, beyond } of panels) {
        expect(beyond, `${at}: parts that stick out of ${name}`).toEqual([]);
        expect(left, `${at}: left edge of ${name}`).toBeGreaterThanOrEqual(0);
        expect(right, `${at}: right edge of ${name}`).toBeLessThanOrEqual(size.width);
      }
      for (const [i, a] of panels.entries())
        for (const b of panels.slice(i + 1)) {
          const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
          const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
          expect(Math.min(across, down), `${at}: ${a.name} over ${b.name}`).toBeLessThanOrEqual(0.5);
        }
    }).toPass({ timeout: 120_000 });
    for (const name of PANELS) {
      const last = page.getByRole("region", { name }).locator(":scope > :last-child");
      await last.scrollIntoViewIfNeeded();
      await expect(last, `${at}: the end of ${name} can be reached`).toBeInViewport();
    }
  }
});
