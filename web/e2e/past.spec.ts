import { expect, test } from "./lab";
import { expectClean, SCREENS, showOn } from "./screens";

interface Bench {
  id: string;
  tick: number;
  state: string;
  controller: string;
  faults: { name: string }[];
  origin: { bench: string; tick: number; is_past: boolean } | null;
}

test("the timeline goes back: all panels show that moment, a change there makes a branch, and the bench is untouched", async ({
  page,
  server,
  openBench,
}) => {
  await openBench("lab", { samples: 1_000_000 });
  const shown = () => new URL(page.url()).searchParams.get("bench") ?? "";
  const ask = (id: string) => server.ask<Bench>("GET", `/benches/${id}`);
  const bench = shown();
  await expect.poll(async () => (await ask(bench)).tick).toBeGreaterThan(400);
  await server.ask("POST", `/benches/${bench}/commands`, { fault: "drive_gain", severity: 0.1 });
  const fault = (await ask(bench)).tick;
  await expect.poll(async () => (await ask(bench)).tick).toBeGreaterThan(fault + 300);

  const timeline = page.getByRole("region", { name: "Timeline" });
  const moment = timeline.getByRole("slider");
  const { x, y, width, height } = (await timeline.locator(".mantine-Slider-root").boundingBox()) ?? {
    x: 0,
    y: 0,
    width: 0,
    height: 0,
  };
  await page.mouse.move(x + width - 2, y + height / 2);
  await page.mouse.down();
  for (const share of [0.8, 0.6, 0.3]) await page.mouse.move(x + width * share, y + height / 2, { steps: 4 });
  await page.mouse.up();
  await page.evaluate(() => new Promise(requestAnimationFrame)); // a slider moves with the next picture

  await expect(timeline.getByText(/^As it was at/)).toBeVisible();
  await expect.poll(shown).not.toBe(bench);
  const past = await expect
    .poll(async () => (await ask(shown())).origin)
    .toMatchObject({ bench, is_past: true })
    .then(() => ask(shown()));
  expect(past.tick).toBeLessThan((await ask(bench)).tick);
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  const at = async () => Number(await moment.getAttribute("aria-valuenow"));
  await expect.poll(async () => (await at()) - (await ask(shown())).tick).toBe(0);
  const tick = await at();
  await moment.focus();
  await page.keyboard.press("ArrowRight");
  await expect.poll(async () => (await ask(shown())).tick).toBe(tick + 1);

  await timeline.getByRole("button", { name: "Branch here" }).click();
  await page.getByRole("menuitem", { name: "With PID" }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  const branch = shown();
  await expect.poll(async () => (await ask(branch)).controller).toBe("pid");
  expect((await ask(branch)).origin).toMatchObject({ bench, is_past: false });
  expect((await ask(bench)).controller).not.toBe("pid");
  await expectClean(page, "a branch");

  await timeline.getByRole("button", { name: "The other future" }).click();
  await expect.poll(shown).toBe(bench);
  await expect(page.getByTestId("bench-state")).toHaveText("running");

  await page.getByRole("tab", { name: "Events" }).click();
  await page
    .getByRole("button", { name: /^Branch without this: .*[Dd]rive/ })
    .first()
    .click();
  await expect.poll(shown).not.toBe(bench);
  await expect.poll(async () => (await ask(shown())).state).toBe("running");
  const without = await ask(shown());
  expect(without.faults).toEqual([]);
  await expect.poll(async () => (await ask(without.id)).tick).toBeGreaterThan(without.origin?.tick ?? Infinity);
  expect((await ask(bench)).faults.map(({ name }) => name)).toEqual(["drive_gain"]);
});

test("from the past one goes back to now, and the bench that showed it is gone; on a phone there is no timeline", async ({
  page,
  server,
  openBench,
}) => {
  await openBench("lab", { samples: 1_000_000 });
  const shown = () => new URL(page.url()).searchParams.get("bench") ?? "";
  const bench = shown();
  await expect.poll(async () => (await server.ask<Bench>("GET", `/benches/${bench}`)).tick).toBeGreaterThan(300);
  const timeline = page.getByRole("region", { name: "Timeline" });
  await timeline.getByRole("slider").focus();
  await page.keyboard.press("Home");
  await expect.poll(shown).not.toBe(bench);
  const past = shown();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await expect(timeline.getByText(/^As it was at/)).toBeVisible();
  await expectClean(page, "the past of a bench");
  await timeline.getByRole("button", { name: "Back to now" }).click();
  await expect.poll(shown).toBe(bench);
  await expect
    .poll(async () => (await server.ask<{ benches: Bench[] }>("GET", "/benches")).benches.map(({ id }) => id))
    .not.toContain(past);
  await showOn(page, SCREENS[3]);
  await expect(timeline).toBeHidden();
});

test("a bench that trips is forked from before it without anything having been kept", async ({
  page,
  server,
  openBench,
}) => {
  await openBench("lab", { samples: 1_000_000 });
  const shown = () => new URL(page.url()).searchParams.get("bench") ?? "";
  const bench = shown();
  await expect.poll(async () => (await server.ask<Bench>("GET", `/benches/${bench}`)).tick).toBeGreaterThan(500);
  await server.ask("POST", `/benches/${bench}/commands`, { set: { "guard.travel_um": 0.001 } });
  await page.getByRole("button", { name: "Fork from before" }).click();
  await expect.poll(shown).not.toBe(bench);
  const tripped = await server.ask<Bench & { trip: { tick: number } }>("GET", `/benches/${bench}`);
  const made = await server.ask<Bench & { trip: null }>("GET", `/benches/${shown()}`);
  expect(made.trip).toBeNull();
  expect(made.tick).toBeLessThan(tripped.trip.tick);
});
