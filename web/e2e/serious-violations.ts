import AxeBuilder from "@axe-core/playwright";
import type { Page } from "@playwright/test";

/** What axe finds on a page that keeps people out, one line each. */
export async function seriousViolations(page: Page): Promise<string[]> {
  // what fades in has the contrast of its end once it is there
  await page.waitForFunction(() =>
    document.getAnimations().every((a) => a.playState !== "running" || a.effect?.getTiming().iterations === Infinity),
  );
  const { violations } = await new AxeBuilder({ page }).exclude("iframe").analyze();
  return violations
    .filter((v) => v.impact === "serious" || v.impact === "critical")
    .map((v) => `${v.id}: ${v.help}: ${v.nodes.map((n) => n.target.join(" ")).join(" | ")}`);
}

/** Letters that are too faint to read, in the colours of now. */
export async function contrastFaults(page: Page, within = "body"): Promise<string[]> {
  const builder = new AxeBuilder({ page })
    .include(within)
    .exclude("iframe")
    .withRules("color-contrast")
    .setLegacyMode();
  const { violations } = await builder.analyze();
  return violations.flatMap((v) => v.nodes.map((n) => `${n.target.join(" ")}: ${n.any[0]?.message}`));
}
