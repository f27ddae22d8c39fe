import type { Page } from "@playwright/test";
import { expect, test } from "../e2e/lab";

/** Ticks a bench has run; its history holds the last 200 000 of them. */
const TICKS = 5_000_000;
const WITHIN_HISTORY = 180_000;
const LOOKS = Number(process.env.LOOKS ?? 20);
const EIGHT = 8;
const SECONDS = Number(process.env.SECONDS ?? 10);

const p95 = (values: number[]) => values.toSorted((a, b) => a - b)[Math.ceil(0.95 * values.length) - 1];
const median = (values: number[]) => values.toSorted((a, b) => a - b)[Math.floor(values.length / 2)];
const shown = (page: Page) => new URL(page.url()).searchParams.get("bench") ?? "";

/** Wall time from a click on the timeline until the first scope has drawn a picture that ends at another moment. */
const click = async (page: Page, x: number, y: number): Promise<number> => {
  await page.evaluate(() => {
    const { fillText } = CanvasRenderingContext2D.prototype;
    Object.assign(window, { looked: undefined });
    const before = new Set<string>();
    let began: number | undefined;
    CanvasRenderingContext2D.prototype.fillText = function (text, ...rest) {
      if (this.canvas.closest("section[aria-label^='Scope: plant']")) {
        if (began === undefined) before.add(text);
        else if (!before.has(text) && /\d/.test(text)) {
          Object.assign(window, { looked: performance.now() - began });
          CanvasRenderingContext2D.prototype.fillText = fillText;
        }
      }
      return fillText.call(this, text, ...rest);
    };
    document.addEventListener(
      "pointerdown",
      () => {
        began = performance.now();
      },
      { once: true, capture: true },
    );
  });
  await page.waitForTimeout(400); // the labels of now are known
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.up();
  const looked = () => page.evaluate(() => (window as unknown as { looked?: number }).looked ?? 0);
  await expect.poll(looked, { intervals: [20], timeout: 20_000 }).toBeGreaterThan(0);
  return looked();
};

test("another moment of the past is shown", async ({ page, server, openBench }) => {
  await openBench("lab", { samples: 100_000_000 });
  const bench = shown(page);
  const command = (body: object) => server.ask("POST", `/benches/${bench}/commands`, body);
  const tick = async () => (await server.ask<{ tick: number }>("GET", `/benches/${bench}`)).tick;
  await command({ kind: "time_scale", value: null });
  await expect.poll(tick, { timeout: 120_000 }).toBeGreaterThan(TICKS);
  await command({ kind: "pause" });
  const end = await tick();
  const slider = page.getByRole("region", { name: "Timeline" }).locator(".mantine-Slider-root");
  const at = async (moment: number) => {
    const { x, y, width, height } = (await slider.boundingBox()) ?? { x: 0, y: 0, width: 0, height: 0 };
    return click(page, x + (width * moment) / end, y + height / 2);
  };
  await at(end - WITHIN_HISTORY); // a bench of its own is made for the first look
  const far: number[] = [];
  for (let look = 0; look < LOOKS; look += 1) far.push(await at(end * (0.02 + (0.9 * ((7 * look) % LOOKS)) / LOOKS)));
  console.log(
    `beyond the history, over the last ${end} ticks: median ${median(far).toFixed(0)} ms, p95 ${p95(far).toFixed(0)} ms`,
  );
  // within the history a pixel is 5000 ticks: the places lie side by side
  const near: number[] = [];
  for (let look = 0; look < LOOKS; look += 1)
    near.push(await at(end - WITHIN_HISTORY + (WITHIN_HISTORY * ((7 * look) % LOOKS)) / LOOKS));
  console.log(`within the history: median ${median(near).toFixed(0)} ms, p95 ${p95(near).toFixed(0)} ms`);
});

test("a frame of a live scope with eight past runs behind it", async ({ page, server, openBench }) => {
  await openBench("lab", { samples: 100_000_000 });
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable");
  const script = async () => {
    const { metrics } = await session.send("Performance.getMetrics");
    return metrics.find(({ name }) => name === "ScriptDuration")?.value ?? 0;
  };
  const scope = page.getByRole("region", { name: /^Scope: plant.displacement/ });
  await page.evaluate(() => {
    const { clearRect } = CanvasRenderingContext2D.prototype;
    Object.assign(window, { frames: 0 });
    CanvasRenderingContext2D.prototype.clearRect = function (...box) {
      if (this.canvas.closest("section[aria-label^='Scope: plant']"))
        Object.assign(window, { frames: (window as unknown as { frames: number }).frames + 1 });
      return clearRect.apply(this, box);
    };
  });
  await scope.getByRole("group", { name: /^Plot/ }).waitFor();
  const frames = () => page.evaluate(() => (window as unknown as { frames: number }).frames);
  const perFrame = async () => {
    const [before, began] = [await script(), await frames()];
    await page.waitForTimeout(1000 * SECONDS);
    return (1000 * ((await script()) - before)) / ((await frames()) - began);
  };
  await page.waitForTimeout(3000);
  const alone = await perFrame();
  const others = await Promise.all(
    Array.from({ length: EIGHT }, () => server.ask<{ id: string }>("POST", `/benches/${shown(page)}/fork`, {})),
  );
  await page.getByRole("button", { name: "Compare", exact: true }).click();
  const sheet = page.getByRole("dialog", { name: "Compare with other benches" });
  for (const { id } of others) await sheet.getByRole("combobox", { name: "Add" }).selectOption(`b ${id}`);
  await page.keyboard.press("Escape");
  await expect(sheet).toBeHidden();
  await page.waitForTimeout(3000);
  const behind = await perFrame();
  console.log(
    `script per frame: ${alone.toFixed(2)} ms alone, ${behind.toFixed(2)} ms with ${EIGHT} behind, ${(behind - alone).toFixed(2)} ms more`,
  );
});
