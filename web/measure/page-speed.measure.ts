import type { CDPSession, Page } from "@playwright/test";
import { test } from "../e2e/lab";

const SCOPES = 8;
const TRACES = 6;
/** 2000 points of a board at 100 kHz. */
const WINDOW_MS = 20;
const SECONDS = Number(process.env.SECONDS ?? 20);
const MINUTES = Number(process.env.MINUTES ?? 30);
const CLICKS = Number(process.env.CLICKS ?? 40);

/** A layout of nothing but scopes, as the dock stores it. */
function scopes(signals: readonly string[]): object {
  const ids = Array.from({ length: SCOPES }, (_, i) => `scope-${i}`);
  const leaf = (id: string) => ({ type: "leaf", size: 400, data: { views: [id], activeView: id, id } });
  const column = (at: number) => ({ type: "branch", size: 340, data: [leaf(ids[2 * at]), leaf(ids[2 * at + 1])] });
  const trigger = { signal: signals[0], edge: "rising", level: 0, hysteresis: 0.1, position: 0.1, sweep: "auto" };
  const panel = (id: string, i: number) => {
    const shown = Array.from({ length: TRACES }, (_, k) => signals[(i + k) % signals.length]);
    const scope = { signals: shown, mode: "roll", windowMs: WINDOW_MS, trigger };
    return [id, { id, contentComponent: "scope", title: id, params: { scope } }];
  };
  return {
    grid: {
      root: { type: "branch", size: 800, data: [0, 1, 2, 3].map(column) },
      width: 1360,
      height: 800,
      orientation: "HORIZONTAL",
    },
    panels: Object.fromEntries(ids.map(panel)),
    activeGroup: ids[0],
  };
}

/** Open eight scopes of six traces on a running bench. */
async function openScopes(page: Page): Promise<void> {
  const signals = await page.evaluate(async () => {
    const id = new URLSearchParams(window.location.search).get("bench");
    const { signals } = await (await fetch(`./api/v1/benches/${id}`)).json();
    return (signals as { name: string; unit: string }[]).filter((s) => /um|V/.test(s.unit)).map((s) => s.name);
  });
  await page.evaluate(
    ([key, text]) => {
      localStorage.setItem(key, text);
      localStorage.setItem = () => undefined; // the page would keep what it shows now
    },
    ["combbench.layout.4.lab", JSON.stringify(scopes(signals))],
  );
  await page.reload();
  await page
    .locator("section[aria-label^='Scope'] canvas")
    .nth(SCOPES - 1)
    .waitFor();
}

async function metrics(session: CDPSession): Promise<Record<string, number>> {
  const { metrics } = await session.send("Performance.getMetrics");
  return Object.fromEntries(metrics.map(({ name, value }) => [name, value]));
}

/** Count how often each canvas is drawn anew: a painter clears it first. */
const countRedraws = (page: Page) =>
  page.evaluate(() => {
    const { clearRect } = CanvasRenderingContext2D.prototype;
    const counts = new Map<HTMLCanvasElement, number>();
    CanvasRenderingContext2D.prototype.clearRect = function (...box) {
      counts.set(this.canvas, (counts.get(this.canvas) ?? 0) + 1);
      return clearRect.apply(this, box);
    };
    Object.assign(window, { redraws: () => [...counts.values()].sort((a, b) => b - a) });
  });

const redraws = (page: Page) => page.evaluate(() => (window as unknown as { redraws(): number[] }).redraws());

const median = (values: number[]) => values.toSorted((a, b) => a - b)[Math.floor(values.length / 2)];

test("eight scopes of six traces of 2000 points", async ({ page, openBench }) => {
  await openBench("lab");
  await openScopes(page);
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable");
  await page.waitForTimeout(5000);
  await countRedraws(page);
  const [before, began] = [await metrics(session), await redraws(page)];
  await page.waitForTimeout(1000 * SECONDS);
  const [after, ended] = [await metrics(session), await redraws(page)];
  const drawn = ended.slice(0, SCOPES).map((count, i) => (count - (began[i] ?? 0)) / SECONDS);
  const script = after.ScriptDuration - before.ScriptDuration;
  const task = after.TaskDuration - before.TaskDuration;
  const frames = Math.max(...drawn) * SECONDS;
  console.log(
    `redraws of a scope per second: median ${median(drawn).toFixed(1)}, least ${Math.min(...drawn).toFixed(1)}`,
  );
  console.log(
    `script per frame ${((1000 * script) / frames).toFixed(2)} ms, all work ${((1000 * task) / frames).toFixed(2)} ms`,
  );
});

test("from a click to its effect", async ({ page, openBench }) => {
  await openBench("lab");
  const inject = page.getByRole("button", { name: /^Inject \+5.*Added mass$/ });
  const heal = page.getByRole("button", { name: "Heal all" });
  await inject.waitFor();
  const took: number[] = [];
  for (let i = 0; i < CLICKS; i++) {
    const button = i % 2 ? heal : inject;
    const [name, effect] = i % 2 ? ["Heal all", "The device is healthy"] : ["Inject", "1 active fault"];
    await button.waitFor();
    took.push(
      await button.evaluate(
        (element, text) =>
          new Promise<number>((resolve) => {
            const began = performance.now();
            const observer = new MutationObserver(() => {
              if (!document.body.innerText.replaceAll("\u00a0", " ").includes(text)) return;
              observer.disconnect();
              requestAnimationFrame(() => resolve(performance.now() - began));
            });
            observer.observe(document.body, { subtree: true, childList: true, characterData: true });
            (element as HTMLElement).click();
          }),
        effect,
      ),
    );
    await page.waitForTimeout(150);
    if (took[i] > 5000) throw new Error(`${name} took ${took[i]} ms`);
  }
  const sorted = took.toSorted((a, b) => a - b);
  const p95 = sorted[Math.ceil(0.95 * sorted.length) - 1];
  console.log(`click to effect over ${CLICKS}: median ${median(took).toFixed(0)} ms, p95 ${p95.toFixed(0)} ms`);
});

test("the heap over half an hour", async ({ page, openBench }) => {
  await openBench("lab");
  await openScopes(page);
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable");
  const heap = async () => {
    await session.send("HeapProfiler.collectGarbage");
    return (await metrics(session)).JSHeapUsedSize / 2 ** 20;
  };
  await page.waitForTimeout(60_000);
  const first = await heap();
  for (let minute = 1; minute <= MINUTES; minute++) {
    await page.waitForTimeout(60_000);
    if (minute % 5 === 0 || minute === MINUTES)
      console.log(`${minute} min: ${(await heap()).toFixed(1)} MiB of ${first.toFixed(1)} after the first`);
  }
});
