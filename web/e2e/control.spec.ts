import { readFile } from "node:fs/promises";
import { benchOf } from "./classroom";
import { chooseMore, expect, front, test } from "./lab";

test("a controller is switched, keys act after lists and fields, a wrong value is refused in words, all is saved, another device begins again", async ({
  page,
  server,
  openBench,
}) => {
  await openBench();
  const state = page.getByTestId("bench-state");
  const controller = page.getByRole("combobox", { name: "Controller" }).first();
  await controller.click();
  await page.keyboard.press("Escape");
  await page.keyboard.press("t");
  await expect(page.getByRole("heading", { name: "Theory" })).toBeVisible();
  await page.getByRole("textbox", { name: "Search equations" }).fill("t");
  await page.keyboard.press("Escape");
  await page.keyboard.press("b");
  await server.advance(3); // for a before
  await controller.click();
  await page.getByRole("option", { name: /^Direct MRAC Direct model/ }).click();
  const strip = page.getByRole("region", { name: "Before and after" }).first();
  await server.advance(8);
  await expect(strip).toContainText(
    /Switch to Direct MRAC at [\d.]+\sms.*(larger|smaller|unchanged)before .* → now .* RMS/,
  );
  await expect(strip).not.toContainText("still settling");
  const [slide] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("s")]);
  expect(slide.suggestedFilename()).toMatch(/^first-look-.*mrac.*-slide\.png$/i);
  await strip.getByRole("button", { name: "Dismiss" }).click();
  await expect(strip).toBeHidden();
  await page.keyboard.press("Space");
  await expect(state).toHaveText("paused");
  const tick = async () => (await server.ask<{ tick: number }>("GET", `/benches/${benchOf(page)}`)).tick;
  const before = await tick();
  await page.keyboard.press(".");
  await expect.poll(tick).toBe(before + 1);
  await page.keyboard.press("Space");
  await expect(state).toHaveText("running");
  await front(page, "Log", "Events");
  await expect(page.getByRole("button", { name: /^\d.*switch to mrac/ })).toBeVisible();
  const scale = page.getByRole("group", { name: "Time scale" });
  await page.keyboard.press("]");
  await expect(scale.getByRole("button", { name: /^4\.00/ })).toBeVisible();
  await server.advance(3);
  await expect(scale.getByText(/runs (4\.0|3\.9)\d\sms\/s/)).toBeVisible();
  await page.keyboard.press("[");
  await expect(scale.getByRole("button", { name: /^2\.00/ })).toBeVisible();

  await page.getByRole("button", { name: /Sensor ?Ideal/ }).click();
  const noise = page.getByRole("textbox", { name: /^Noise, µm/ });
  await noise.fill("0.2");
  await noise.press("Enter");
  await front(page, "Log", "Events");
  await expect(page.getByRole("button", { name: /^\d.*set sensors?\..*noise_um = 0\.2/ })).toBeVisible();
  await noise.fill("-1");
  await noise.press("Enter");
  await expect(page.getByRole("alert").filter({ hasText: "at least 0" })).toBeVisible();

  const [download] = await Promise.all([page.waitForEvent("download"), chooseMore(page, /^Save this run/)]);
  expect(await readFile(await download.path(), "utf8")).toMatch(/sensors?\..*noise_um/);
  expect(download.suggestedFilename()).toMatch(/^first-look-\d+\.toml$/);

  const bench = benchOf(page);
  const device = page.getByRole("combobox", { name: "Device" });
  await device.click();
  await page.getByRole("option", { name: /^LCR-350/ }).click();
  await page.getByRole("button", { name: "Begin again" }).click();
  await expect.poll(() => benchOf(page)).not.toBe(bench);
  await expect(device).toHaveValue("LCR-350, from geometry");
  await expect(controller).toHaveValue("Direct MRAC");
});

test("a fault, a healing, a closed panel and a reset are taken back and made again, by key, button and notice", async ({
  page,
  server,
  openBench,
}) => {
  await openBench();
  const faults = page.getByRole("region", { name: "Faults" });
  const acting = faults.getByText(/^1\sactive fault$/);
  const body = page.locator("body");
  await faults.getByRole("button", { name: /^Inject .*Added mass/ }).click();
  await expect(acting).toBeVisible();
  await chooseMore(page, /^Undo: Added mass \+5/);
  await expect(acting).toBeHidden();
  await body.press("Control+y");
  await expect(acting).toBeVisible();
  const takeBack = (words: string) =>
    page.getByRole("alert").filter({ hasText: words }).getByRole("button", { name: "Undo" }).click();
  await body.press("h");
  await expect(acting).toBeHidden();
  await takeBack("All faults healed");
  await expect(acting).toBeVisible();

  const panels = page.getByRole("tab");
  const many = await panels.count();
  await page.getByRole("button", { name: "Add or close panels" }).first().click();
  await page.getByRole("menuitem", { name: /^Close / }).click();
  await expect(panels).toHaveCount(many - 1);
  await body.press("Control+z");
  await expect(panels).toHaveCount(many);
  await body.press("Control+z");
  await expect(acting).toBeHidden();

  await server.advance(2);
  const tick = async () => Number((await page.getByRole("timer").locator("small").textContent())?.replace(/\D/g, ""));
  const { tick: reached } = await server.ask<{ tick: number }>("GET", `/benches/${benchOf(page)}`);
  await expect.poll(tick).toBe(reached);
  await body.press("Space");
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await body.press("Shift+R");
  await expect.poll(tick).toBe(0);
  await takeBack("Reset to the start");
  await expect.poll(tick).toBe(reached);
});

test("a runaway controller trips the board, the page says why; the trip is reset, and forked from before it", async ({
  page,
  server,
  openBench,
}) => {
  await openBench("lab", { samples: 1_000_000 });
  const state = page.getByTestId("bench-state");
  const bench = benchOf(page);
  const send = (data: object) => server.ask("POST", `/benches/${bench}/commands`, data);
  await server.advance(2);
  await send({ switch: "mrac", cold: true });
  await send({ set: { "controllers.mrac.adaptation_gain": 30 } });
  await send({ kind: "time_scale", value: 0.1 });
  await server.advance(4);
  await expect(state).toHaveText("tripped");
  await expect(page.getByText(/^Tripped: /)).toBeVisible();
  await expect(page.getByText("The voltage is off")).toBeVisible();
  await page.getByRole("button", { name: "Reset the trip" }).click();
  await expect(state).toHaveText("paused");

  await send({ set: { "guard.travel_um": 0.001 } });
  await send({ kind: "start" });
  await server.advance(1);
  await page.getByRole("button", { name: "Fork from before" }).click();
  await expect.poll(() => benchOf(page)).not.toBe(bench);
  const { trip } = await server.ask<{ trip: { tick: number } }>("GET", `/benches/${bench}`);
  const fork = await server.ask<{ trip: null; tick: number }>("GET", `/benches/${benchOf(page)}`);
  expect(fork.trip).toBeNull();
  expect(fork.tick).toBeLessThan(trip.tick);
});
