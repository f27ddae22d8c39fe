import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import type { Page } from "@playwright/test";
import type axe from "axe-core";

const SOURCE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

// an element that fades in reaches its final contrast at the end
const stillness = async (page: Page) => {
  // it begins to fade with the next frame
  await page.evaluate(() => new Promise((seen) => requestAnimationFrame(() => requestAnimationFrame(seen))));
  await page.waitForFunction(() =>
    document.getAnimations().every((a) => a.playState !== "running" || a.effect?.getTiming().iterations === Infinity),
  );
};

/** What axe says of a page or a part of it; it is brought to a page once, and looks at no other frame. */
async function violationsOf(page: Page, within: string, rules?: string[]): Promise<axe.Result[]> {
  await stillness(page);
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(SOURCE);
  return page.evaluate(
    async ({ within, rules }) => {
      const { axe } = window as unknown as { axe: typeof import("axe-core") };
      const found = await axe.run(
        { include: [within], exclude: ["iframe"] },
        { iframes: false, resultTypes: ["violations"], ...(rules && { runOnly: rules }) },
      );
      return found.violations;
    },
    { within, rules },
  );
}

/** What axe finds on a page that keeps people out, one line each. */
export async function seriousViolations(page: Page): Promise<string[]> {
  const violations = await violationsOf(page, "html");
  return violations
    .filter((v) => v.impact === "serious" || v.impact === "critical")
    .map((v) => `${v.id}: ${v.help}: ${v.nodes.map((n) => n.target.join(" ")).join(" | ")}`);
}

/** Letters that are too faint for their ground, in the colours of now. */
export async function faintLetters(page: Page, within = "body"): Promise<string[]> {
  const violations = await violationsOf(page, within, ["color-contrast"]);
  return violations.flatMap((v) => v.nodes.map((n) => `${n.target.join(" ")}: ${n.any[0]?.message}`));
}
