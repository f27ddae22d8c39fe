import { expect, pictureOf, test } from "./lab";
import { seriousViolations } from "./serious-violations";

interface Shown {
  parameters: { environment?: { pressure_pa: number } };
}

interface Happened {
  events: { command: { set?: Record<string, unknown> } | null }[];
}

const CANVAS = "section[aria-label='Phase plane'] canvas";

test("the phase plane moves, and has the unstable region beneath once the plant can pull in", async ({
  page,
  openBench,
}) => {
  await openBench();
  await page.getByRole("tab", { name: "Phase plane" }).click();
  const panel = page.getByRole("region", { name: "Phase plane" });
  await expect(panel.getByText(/^No unstable region: the linear plant/)).toBeVisible();
  for (const width of [1366, 1920, 820]) {
    await page.setViewportSize({ width, height: 768 });
    await expect.poll(() => page.locator(CANVAS).evaluate(outOfSquare)).toBeLessThanOrEqual(2);
  }
  const before = await pictureOf(page, CANVAS);
  await expect.poll(() => pictureOf(page, CANVAS)).not.toBe(before);

  await panel.getByRole("button", { name: "Use the planar plant" }).click();
  await expect(panel.getByText(/a slow drive folds at \d\.\d\d\sµm and \d[\d.]+\sV/)).toBeVisible();
  await expect(panel.getByRole("img", { name: /over the map of the unstable region$/ })).toBeVisible();
  await panel.getByRole("combobox", { name: "Across" }).selectOption("drive.voltage");
  await expect(panel.getByText(/is drawn over a displacement/)).toBeVisible();
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
});

test("a swept sine says what the device is, and the environment changes live", async ({ page, openBench, server }) => {
  await openBench();
  const id = new URL(page.url()).searchParams.get("bench");
  // what the board has, not what the page shows: the sweep asks the board
  const air = async () => {
    const { parameters } = await server.ask<Shown>("GET", `/benches/${id}`);
    return parameters.environment?.pressure_pa;
  };
  const sensors = async () => {
    const { events } = await server.ask<Happened>("GET", `/benches/${id}/events`);
    return events.flatMap(({ command }) => command?.set?.["sensor.kind"] ?? []);
  };
  await page.getByRole("tab", { name: "Environment" }).click();
  const pressure = page.getByRole("textbox", { name: "Pressure, Pa" });
  await pressure.fill("20000");
  await pressure.press("Enter");
  await expect.poll(air).toBe(20000);
  // in ns or µs: how long a tick takes is the machine's affair
  await expect(page.getByText(/^[\d.]+\s[nµm]?s per tick of the whole bench/).first()).toBeVisible();
  // three choices faster than the board answers: each is meant from the one before
  await page.getByRole("combobox", { name: "Sensor that feeds the controllers" }).selectOption("capacitive");
  const bypass = page.getByRole("button", { name: "Bypass" });
  await bypass.dblclick();
  await expect.poll(sensors).toEqual(["capacitive", "ideal", "capacitive"]);
  await expect(bypass).toHaveAttribute("aria-pressed", "false");
  await bypass.click();
  await expect.poll(sensors).toEqual(["capacitive", "ideal", "capacitive", "ideal"]);
  await expect(bypass).toHaveAttribute("aria-pressed", "true");

  await page.getByRole("tab", { name: "Swept sine" }).click();
  await page.getByRole("button", { name: "Sweep the device" }).click();
  await expect(page.getByRole("row", { name: /^Resonance f₀ 2\.48\d+ kHz/ })).toBeVisible();
  // a fifth of the pressure: less damping, and the sweep sees it
  await expect(page.getByRole("row", { name: /^Damping β .*−\d/ })).toBeVisible();
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
});

test("the spectrum finds the tone of the drive", async ({ page, openBench }) => {
  await openBench();
  await page.getByRole("tab", { name: "Spectrum" }).click();
  const panel = page.getByRole("region", { name: "Spectrum" });
  // 10 V at 2 kHz
  await panel.getByRole("combobox", { name: "Signal" }).selectOption("reference.voltage");
  await expect(panel.getByText(/^Strongest: (10\.0|9\.9\d|10\.1)\sV at (2\.00\d|1\.99\d)\skHz$/)).toBeVisible();
});

/** How much longer one axis of the field is than the other, px, by the lines they stand on. */
function outOfSquare(canvas: HTMLCanvasElement): number {
  const context = canvas.getContext("2d") as CanvasRenderingContext2D;
  const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
  const [across, up] = [[] as number[], [] as number[]];
  for (let y = 0; y < canvas.height; y += 1)
    for (let x = 0; x < canvas.width; x += 1) {
      const at = 4 * (y * canvas.width + x);
      const isAxis = [185, 194, 204].every((value, k) => Math.abs(data[at + k] - value) < 3) && data[at + 3] > 250;
      if (!isAxis) continue;
      across.push(x);
      up.push(y);
    }
  const length = (places: number[]) =>
    places.reduce((a, b) => Math.max(a, b), 0) - places.reduce((a, b) => Math.min(a, b));
  return across.length === 0 ? Number.POSITIVE_INFINITY : Math.abs(length(across) - length(up));
}
