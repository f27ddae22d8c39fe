import type { Locator } from "@playwright/test";
import { expect, test } from "./lab";

/** Pixels: of a trace that rests, and of one with a spike, which fills most of the plot. */
const FLAT = 12;
const TALL = 60;

const SPIKE_AT = 120_000;
/** The history has forgotten the spike by then. */
const BEYOND_HISTORY = 450_000;

/** A device that rests, and one tick at which its sensor says otherwise. */
const SPIKE = {
  schema: 1,
  id: "spike",
  title: "A spike of one tick",
  sample_rate_khz: 100,
  samples: 10_000_000,
  device: { id: "ch3" },
  plant: { model: "linear", thermal_noise: false },
  reference: { kind: "sine", amplitude_v: 0, frequency_hz: 1000 },
  controller: { kind: "open_loop" },
  sensor: { kind: "ideal", noise_um: 0 },
  diagnosers: {},
  events: [
    { at_sample: SPIKE_AT, fault: "sensor_bias", severity: 3 },
    { at_sample: SPIKE_AT + 1, heal: "all" },
  ],
};

/** The rows between the lowest and the highest that the only trace of a scope inks. */
const height = (scope: Locator): Promise<number> =>
  scope.evaluate((panel) => {
    const line = panel.querySelector("[aria-label='Signals'] svg line, [aria-label='Signals'] svg path") as Element;
    const wanted = (getComputedStyle(line).stroke.match(/\d+/g) ?? []).slice(0, 3).map(Number);
    const canvas = panel.querySelector("canvas") as HTMLCanvasElement;
    const { width, height } = canvas;
    const { data } = (canvas.getContext("2d") as CanvasRenderingContext2D).getImageData(0, 0, width, height);
    const rows = Array.from({ length: height }, (_, y) => y).filter((y) => {
      for (let at = 4 * y * width; at < 4 * (y + 1) * width; at += 4)
        if (data[at + 3] > 200 && wanted.every((part, i) => Math.abs(data[at + i] - part) < 12)) return true;
      return false;
    });
    return rows.length < 2 ? 0 : ((rows[rows.length - 1] - rows[0]) * canvas.clientHeight) / height;
  });

/** Take a signal off a scope. */
async function removeSignal(scope: Locator, name: string): Promise<void> {
  await scope.getByRole("button", { name: "Choose signals" }).click();
  const picker = scope.page().getByRole("dialog");
  await picker.getByLabel("Search signals").fill(name);
  await picker
    .getByRole("checkbox", { name: /^displacement/, checked: true })
    .first()
    .uncheck();
  await scope.getByRole("button", { name: "Choose signals" }).click();
  await expect(picker).toBeHidden();
}

test("a spike of one tick is seen live, looked back at, and at a moment of the past, at every zoom", async ({
  page,
  server,
  openDocument,
}) => {
  const id = await openDocument(SPIKE);
  const command = (body: object) => server.ask("POST", `/benches/${id}/commands`, body);
  let now = 0;
  const stepTo = async (tick: number) => {
    for (; now < tick; now += Math.min(10_000, tick - now))
      await command({ kind: "step", ticks: Math.min(10_000, tick - now) });
  };
  const scope = page.getByRole("region", { name: /^Scope: .*sensor.displacement/ });
  const windows = scope.getByRole("combobox", { name: "Time window" });
  const tall = (where: string) => expect.poll(() => height(scope), where).toBeGreaterThan(TALL);
  await command({ kind: "pause" });
  for (const other of ["plant", "model"]) await removeSignal(scope, `${other}.displacement`);
  await stepTo(SPIKE_AT);
  await windows.selectOption("1000");
  await expect.poll(() => height(scope), "a sensor that rests").toBeLessThan(FLAT);

  await windows.selectOption("2");
  await stepTo(SPIKE_AT + 100);
  await expect(page.getByRole("timer", { name: "Device time" })).toContainText(/120\s?100$/);
  await tall("live, 2 ms"); // the spike is in the middle
  await scope.getByRole("group", { name: /^Plot/ }).focus();
  for (let zoom = 1; zoom <= 10; zoom += 1) {
    await page.keyboard.press("+");
    await tall(`looked back at, ${zoom} times closer`);
  }
  await page.keyboard.press("l");
  for (const window of ["50", "1000"]) {
    await windows.selectOption(window);
    await tall(`live, ${window} ms`);
  }

  await windows.selectOption("1000");
  await stepTo(BEYOND_HISTORY);
  await expect.poll(() => height(scope), "it has left the window").toBeLessThan(FLAT);
  const { id: past } = await server.ask<{ id: string }>("POST", `/benches/${id}/fork`, {
    tick: SPIKE_AT + 8000,
    paused: true,
    window_ticks: 20_000,
  });
  await page.goto(`${server.origin}/?bench=${past}&layout=lab`);
  await expect(page.getByText(/^As it was at/)).toBeVisible();
  for (const window of ["1000", "200"]) {
    await windows.selectOption(window);
    await tall(`a moment computed again, ${window} ms`);
  }
});
