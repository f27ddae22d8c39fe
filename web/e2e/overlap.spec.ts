import type { Page } from "@playwright/test";
import { expect, test } from "./lab";

const SIZES = [
  { width: 1366, height: 768 },
  { width: 1920, height: 1080 },
  { width: 820, height: 1180 },
  { width: 390, height: 844 },
];
const LAYOUTS = ["lab", "research", "lecture"] as const;
const SHEETS = [
  { key: "S", title: "Share this experiment" },
  { key: "n", title: "Mine" },
];
const PAGES = ["Gallery", "Runs", "Design", "Theory"];

/** What is cut, lies over something else, or makes the page wider than its window. */
const faults = (page: Page, within = "body"): Promise<string[]> =>
  page.evaluate((within) => {
    const found: string[] = [];
    const name = (e: Element) =>
      `${e.tagName.toLowerCase()} "${(e.getAttribute("aria-label") ?? e.textContent ?? "").trim().slice(0, 40)}"`;
    const wide = document.documentElement.scrollWidth - window.innerWidth;
    if (wide > 0) found.push(`the page is ${wide} px wider than its window`);
    const scrolls = (e: Element) => /auto|scroll/.test(getComputedStyle(e).overflowX + getComputedStyle(e).overflowY);
    /** The part of an element that its scrolling and hiding ancestors leave. */
    const visible = (e: Element) => {
      let { left, top, right, bottom } = e.getBoundingClientRect();
      for (let up = e.parentElement; up; up = up.parentElement) {
        if (getComputedStyle(up).overflow === "visible") continue;
        const box = up.getBoundingClientRect();
        left = Math.max(left, box.left);
        top = Math.max(top, box.top);
        right = Math.min(right, box.right);
        bottom = Math.min(bottom, box.bottom);
      }
      return { left, top, right, bottom };
    };
    for (const e of Array.from(
      document.querySelectorAll(`${within} :is(button, a, input, select, textarea, [role=tab])`),
    )) {
      if (!e.checkVisibility({ checkOpacity: true, checkVisibilityCSS: true }) || e.closest("[aria-hidden=true]"))
        continue;
      const box = e.getBoundingClientRect();
      const seen = visible(e);
      // half scrolled away is no fault, only what is meant to be whole
      if (seen.right - seen.left < box.width - 1 || seen.bottom - seen.top < box.height - 1 || box.width < 2) {
        const cut = [...ancestors(e)].find((up) => getComputedStyle(up).overflowX === "hidden" && !scrolls(up));
        const lost = cut && box.right > cut.getBoundingClientRect().right + 1 && !e.matches("[role=tab]");
        if (lost && box.width >= 2 && ![...ancestors(e)].some(scrolls)) found.push(`${name(e)} is cut`);
        continue;
      }
      const middle = document.elementFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2);
      if (middle && !e.contains(middle) && !middle.contains(e) && !middle.closest("label")?.contains(e))
        found.push(`${name(middle)} lies over ${name(e)}`);
    }
    const words = "button, button span, h1, h2, h3, label, dt, dd, th, td, p, figcaption, strong";
    for (const e of Array.from(document.querySelectorAll(`${within} :is(${words})`))) {
      if (!e.checkVisibility({ checkOpacity: true, checkVisibilityCSS: true })) continue;
      const style = getComputedStyle(e);
      const size = Number.parseFloat(style.fontSize);
      const says = Array.from(e.childNodes).some((n) => n.nodeType === Node.TEXT_NODE && n.textContent?.trim());
      if (says && size < 10.99 && !e.closest(".katex")) found.push(`${name(e)} is ${size} px high`);
      if (style.overflowX === "hidden" && style.textOverflow !== "ellipsis" && e.scrollWidth > e.clientWidth + 1)
        found.push(`${name(e)} is cut`);
    }
    return [...new Set(found)];

    function* ancestors(e: Element) {
      for (let up = e.parentElement; up; up = up.parentElement) yield up;
    }
  }, within);

for (const { width, height } of SIZES)
  test(`nothing overlaps or is cut at ${width} x ${height}`, async ({ page, openBench }) => {
    await page.setViewportSize({ width, height });
    await page.emulateMedia({ colorScheme: width > 1000 ? "light" : "dark" });
    // what comes or goes may lie over something for a moment
    const clean = (where: string, within?: string) =>
      expect.poll(() => faults(page, within), { message: where }).toEqual([]);
    for (const layout of LAYOUTS) {
      await openBench(layout);
      await expect(page.locator("canvas").first()).toBeVisible();
      await clean(layout);
    }
    for (const { key, title } of SHEETS) {
      await page.keyboard.press(key);
      if (title === "Mine") await page.getByRole("button", { name: "Open a scenario from disk" }).click();
      const sheet = page.getByRole("dialog", { name: title });
      await expect(sheet.getByRole("button").nth(1)).toBeVisible();
      await clean(title, "[role=dialog]");
      await sheet.getByRole("button", { name: "Close" }).click();
      await expect(sheet).toBeHidden();
    }
    for (const name of PAGES) {
      await page.getByRole("button", { name, exact: true }).click();
      await expect(page.getByRole("button", { name, exact: true })).toHaveAttribute("aria-current", "page");
      await expect(page.locator("main :is(h1, h2, h3, table, svg, li)").first()).toBeVisible();
      await clean(name);
    }
  });
