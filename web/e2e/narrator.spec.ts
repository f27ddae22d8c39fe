import { expect, test } from "./lab";
import { expectClean, expectFits, expectReadable, SCHEMES, SCREENS, showOn } from "./screens";

/** What the seven steps say after their faults begin. */
const STEPS = [
  "mass +5\u00a0%",
  "mass +10\u00a0%",
  "stiffness +5\u00a0%",
  "stiffness +10\u00a0%",
  "damping +30\u00a0%",
  "healthy",
];

test("the seven steps are told, shown on the scopes, spoken, and remembered to be off", async ({ page, server }) => {
  const { id } = await server.ask<{ id: string }>("POST", "/benches", {
    scenario: "ch5-seven-step",
    time_scale: 0.02,
    paused: true,
  });
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?bench=${id}&layout=lecture`);
  const caption = page.getByRole("region", { name: "What happens now" });
  await expect(caption).toContainText("Each lane of Diagnosis is one guess at the device");
  await expectClean(page, "the narrator before anything is said", "section[aria-label='What happens now']");
  await page.keyboard.press("Space");
  const spoken = page.getByRole("status").filter({ hasText: "belief turns to the lane" });
  await expect(spoken.first()).toBeAttached({ timeout: 120_000 });
  await expect(page.getByTestId("bench-state")).toHaveText("paused", { timeout: 120_000 });
  await expect(caption).toContainText("the error is back under", { timeout: 120_000 });
  await caption.getByRole("button", { name: "the error is back under" }).click();
  await expect(page.getByRole("button", { name: "LIVE" }).first()).toBeVisible();
  await expect(page.locator("li[data-told=true]").first()).toBeVisible();

  for (const [width, height] of [
    [1440, 900],
    [390, 844],
  ] as const) {
    await showOn(page, { width, height });
    for (const scheme of SCHEMES) {
      await expectReadable(page, `the narrator, ${width} wide`, scheme, "section[aria-label='What happens now']");
      if (process.env.SHOTS) await page.screenshot({ path: `${process.env.SHOTS}/caption-${width}-${scheme}.png` });
    }
    await expectClean(page, `the narrator, ${width} wide`, "section[aria-label='What happens now']");
  }
  await showOn(page, { width: 1440, height: 900 });

  await page.keyboard.press("q");
  await expect(caption).toHaveCount(0);
  await page.reload();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await expect(caption).toHaveCount(0);
  await page.keyboard.press("q");
  await expect(caption).toBeVisible();

  await page.keyboard.press("3");
  await page.getByRole("tab", { name: "Narrator" }).click();
  const list = page.getByRole("list", { name: "What the narrator says" });
  await expect(list.getByRole("listitem")).toHaveCount(15);
  for (const step of STEPS) await expect(list.getByText(`belief turns to the lane ${step} (`)).toHaveCount(1);
  const third = list.getByRole("button", { name: /At 60.00/ });
  await third.click();
  await expect(third).toHaveAttribute("data-chosen", "true");
  await expectClean(page, "the panel of the narrator", "ol[aria-label^='What the narrator']");
  for (const scheme of SCHEMES)
    await expectReadable(page, "the panel of the narrator", scheme, "ol[aria-label^='What the narrator']");
  if (process.env.SHOTS) await page.screenshot({ path: `${process.env.SHOTS}/panel.png` });
});

test("a replay has the sentences as its captions, wherever it is", async ({ page, server }) => {
  const { id } = await server.ask<{ id: string }>("POST", "/benches", { scenario: "ch5-seven-step", paused: true });
  const made = await server.ask<{ id: string }>("POST", `/benches/${id}/recordings`, { name: "steps" });
  for (let tick = 0; tick < 3200; tick += 1600)
    await server.ask("POST", `/benches/${id}/commands`, { kind: "step", ticks: 1600 });
  await server.ask("POST", `/benches/${id}/recordings/${made.id}/stop`);
  const replay = await server.ask<{ id: string }>("POST", `/recordings/${made.id}/replay`, { paused: true });
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?bench=${replay.id}&layout=lecture`);
  const caption = page.getByRole("region", { name: "What happens now" });
  await expect(caption).toContainText("Each lane of Diagnosis");
  const go = (tick: number) => server.ask("POST", `/benches/${replay.id}/commands`, { kind: "seek", tick });
  await go(3100);
  await expect(caption).toContainText("belief turns to the lane mass +10\u00a0%", { timeout: 120_000 });
  await expectFits(page, "a verdict as a caption", "section[aria-label='What happens now']");
  if (process.env.SHOTS)
    for (const screen of SCREENS) {
      await showOn(page, screen);
      await page.screenshot({ path: `${process.env.SHOTS}/verdict-${screen.width}.png` });
    }
  await showOn(page, SCREENS[0]);
  await go(2050);
  await expect(caption).toContainText("belief turns to the lane mass +5\u00a0%", { timeout: 120_000 });
  await go(100);
  await expect(caption).toContainText("Each lane of Diagnosis");
  await page.keyboard.press("3");
  await page.getByRole("tab", { name: "Narrator" }).click();
  const ahead = page.getByRole("button", { name: /At 60.64/ });
  await expect(ahead).toHaveAttribute("data-ahead", "true");
  await ahead.click();
  await expect(caption).toContainText("a fault changes: added mass", { timeout: 120_000 });
  await server.ask("DELETE", `/recordings/${made.id}`);
});
