import { expect, pictureOf, test } from "./lab";
import { seriousViolations } from "./serious-violations";

const CANVAS = "section[aria-label='Phase plane'] canvas";

test("the phase plane moves, and has the unstable region beneath once the plant can pull in", async ({
  page,
  openBench,
}) => {
  await openBench();
  await page.getByRole("tab", { name: "Phase plane" }).click();
  const panel = page.getByRole("region", { name: "Phase plane" });
  await expect(panel.getByText(/^No unstable region: the linear plant/)).toBeVisible();
  const before = await pictureOf(page, CANVAS);
  await expect.poll(() => pictureOf(page, CANVAS)).not.toBe(before);

  await panel.getByRole("button", { name: "Use the planar plant" }).click();
  await expect(panel.getByText(/a slow drive folds at \d\.\d\d\sµm and \d[\d.]+\sV/)).toBeVisible();
  await expect(panel.getByRole("img", { name: /over the map of the unstable region$/ })).toBeVisible();
  await panel.getByRole("combobox", { name: "Across" }).selectOption("drive.voltage");
  await expect(panel.getByText(/lies beneath a displacement/)).toBeVisible();
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
});

test("a swept sine says what the device is, and the environment changes live", async ({ page, openBench }) => {
  await openBench();
  await page.getByRole("tab", { name: "Environment" }).click();
  const pressure = page.getByRole("textbox", { name: "Pressure, Pa" });
  await pressure.fill("20000");
  await pressure.press("Enter");
  await expect(page.getByText(/ns per tick of the whole bench/).first()).toBeVisible();
  await page.getByRole("combobox", { name: "Sensor that feeds the controllers" }).selectOption("capacitive");
  await page.getByRole("button", { name: "Bypass" }).click();
  await expect(page.getByRole("button", { name: "Bypass" })).toHaveAttribute("aria-pressed", "true");

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
