import AxeBuilder from "@axe-core/playwright";
import type { Page } from "@playwright/test";

// what fades in has the contrast of its end once it is there
const stillness = (page: Page) =>
  page.waitForFunction(() =>
    document.getAnimations().every((a) => a.playState !== "running" || a.effect?.getTiming().iterations === Infinity),
  );

/** What axe finds on a page that keeps people out, one line each. */
export async function seriousViolations(page: Page): Promise<string[]> {
  await stillness(page);
  const { violations } = await new AxeBuilder({ page }).exclude("iframe").setLegacyMode().analyze();
  return violations
    .filter((v) => v.impact === "serious" || v.impact === "critical")
    .map((v) => `${v.id}: ${v.help}: ${v.nodes.map((n) => n.target.join(" ")).join(" | ")}`);
}

/** Letters that are too faint for their ground, in the colours of now. */
export async function faintLetters(page: Page, within = "body"): Promise<string[]> {
  await stillness(page);
  const builder = new AxeBuilder({ page })
    .include(within)
    .exclude("iframe")
    .withRules("color-contrast")
    .setLegacyMode();
  const { violations } = await builder.analyze();
  return violations.flatMap((v) => v.nodes.map((n) => `${n.target.join(" ")}: ${n.any[0]?.message}`));
}
