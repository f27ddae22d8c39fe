import type { Page } from "@playwright/test";
import { expect, test } from "../e2e/lab";
import type { LabServer } from "../e2e/lab-server";

interface Ran {
  tick: number;
  first_tick: number;
}

/** Ticks a bench has run; its history holds the last 57 000 of them, as its memory allows. */
const TICKS = 5_000_000;
/** So many are all in the history, and few enough for a pixel of the timeline to be another moment. */
const HISTORY_TICKS = 60_000;
/** Ticks before a moment that its panels can show. */
const WINDOW_TICKS = 20_000;
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

/** Let a bench run as fast as it can to a tick, and look at moments of its past; wall time of each look. */
const looks = async (page: Page, server: LabServer, ticks: number, span: (bench: Ran) => [number, number]) => {
  const bench = shown(page);
  const command = (body: object) => server.ask("POST", `/benches/${bench}/commands`, body);
  const ask = () => server.ask<Ran>("GET", `/benches/${bench}`);
  await command({ kind: "time_scale", value: null });
  await expect.poll(async () => (await ask()).tick, { timeout: 120_000 }).toBeGreaterThan(ticks);
  await command({ kind: "pause" });
  const ran = await ask();
  const [begin, end] = span(ran);
  const slider = page.getByRole("region", { name: "Timeline" }).locator(".mantine-Slider-root");
  const at = async (moment: number) => {
    const { x, y, width, height } = (await slider.boundingBox()) ?? { x: 0, y: 0, width: 0, height: 0 };
    return click(page, x + (width * moment) / ran.tick, y + height / 2);
  };
  await at((begin + end) / 2); // a bench of its own is made for the first look
  const found: number[] = [];
  for (let look = 0; look < LOOKS; look += 1)
    found.push(await at(begin + ((end - begin) * ((7 * look) % LOOKS)) / LOOKS));
  return `ticks ${begin.toFixed(0)} to ${end.toFixed(0)} of ${ran.tick}: median ${median(found).toFixed(0)} ms, p95 ${p95(found).toFixed(0)} ms`;
};

test("another moment of the past is shown, beyond the history", async ({ page, server, openBench }) => {
  await openBench("lab", { samples: 100_000_000 });
  console.log("beyond,", await looks(page, server, TICKS, ({ tick }) => [0.02 * tick, 0.92 * tick]));
});

test("another moment of the past is shown, within the history", async ({ page, server, openBench }) => {
  await openBench("lab", { samples: 100_000_000 });
  const span = ({ first_tick, tick }: Ran): [number, number] => [first_tick + WINDOW_TICKS, tick - 100];
  console.log("within,", await looks(page, server, HISTORY_TICKS, span));
});

test("a frame of a live scope with eight past runs behind it", async ({ page, server, openBench }) => {
  await openBench("lab", { samples: 100_000_000 });
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable", { timeDomain: "threadTicks" }); // what else this machine does is not counted
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
    Array.from({ length: EIGHT }, () =>
      server.ask<{ id: string }>("POST", `/benches/${shown(page)}/fork`, { paused: true }),
    ),
  );
  await page.getByRole("button", { name: "Compare", exact: true }).click();
  const sheet = page.getByRole("dialog", { name: "Compare with other benches" });
  for (const { id } of others) await sheet.getByRole("combobox", { name: "Add" }).selectOption(`b ${id}`);
  await page.keyboard.press("Escape");
  await expect(sheet).toBeHidden();
  await expect(page.getByText(/^Behind, faded: /).first()).toBeVisible();
  await page.waitForTimeout(3000);
  const past = await perFrame();
  for (const { id } of others) await server.ask("POST", `/benches/${id}/commands`, { kind: "start" });
  await page.waitForTimeout(3000);
  const live = await perFrame();
  const more = (figure: number) => `${figure.toFixed(2)} ms (${(figure - alone).toFixed(2)} more)`;
  console.log(
    `script per frame: ${alone.toFixed(2)} ms alone; with ${EIGHT} behind that are over ${more(past)}, that run ${more(live)}`,
  );
});
