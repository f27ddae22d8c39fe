import { expect, test } from "./lab";

/** A device of the test's own, heavier than nominal: samples of the exact motion under a voltage that is held. */
function simulated(samples: number, faultFrom: number): string {
  const dt = 0.02; // ms
  const rows = ["time_ms,drive,displacement"];
  let [x, v, seed] = [0, 0, 1];
  const random = () => {
    seed = (seed * 48_271) % 2_147_483_647;
    return seed / 2_147_483_647;
  };
  for (let i = 0; i < samples; i += 1) {
    const heavy = i >= faultFrom ? 1.1 : 1;
    const [m, b, k, f] = [2.209e-4 * 1.04 * heavy, 7.09e-4 * 0.9, 0.0538 * 0.97, -6.375e-3];
    const t = i * dt;
    const u = 4 * (Math.sin(2 * Math.PI * 1.2 * t) + Math.sin(2 * Math.PI * 2.1 * t) + Math.sin(2 * Math.PI * 2.9 * t));
    const noise = 0.01 * (random() + random() + random() + random() - 2) * Math.sqrt(3);
    rows.push(`${t.toFixed(2)},${u},${x + noise}`);
    // the exact step of a damped oscillator about the rest under this voltage
    const [rest, slow] = [(f * u) / k, b / (2 * m)];
    const fast = Math.sqrt(k / m - slow * slow);
    const [c, s, e] = [Math.cos(fast * dt), Math.sin(fast * dt), Math.exp(-slow * dt)];
    const z = x - rest;
    [x, v] = [rest + e * (z * c + ((v + slow * z) / fast) * s), e * (v * c - ((slow * v + (k / m) * z) / fast) * s)];
  }
  return rows.join("\n");
}

test("a CSV is dropped, calibrated, diagnosed and played on a bench", async ({ page, openBench }) => {
  await openBench("lab");
  const text = simulated(6000, 4000);
  const sheet = page.getByRole("dialog", { name: "A record of your device" });
  await expect(async () => {
    await page.evaluate((content) => {
      const data = new DataTransfer();
      data.items.add(new File([content], "device.csv"));
      document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
    }, text);
    await expect(sheet).toBeVisible({ timeout: 5000 });
  }).toPass();
  await expect(sheet.getByRole("region", { name: "device.csv" })).toBeVisible();
  await expect(sheet.getByText("6000 samples at 50 kHz")).toBeVisible();

  const plot = sheet.getByTestId("record-plot");
  const box = await plot.boundingBox();
  if (!box) throw new Error("the plot has no place");
  await page.mouse.move(box.x + 0.15 * box.width, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 40, { steps: 4 });
  await page.mouse.up();
  const end = Number(await sheet.getByLabel("to before sample").inputValue());
  expect(end).toBeGreaterThan(2000);
  expect(end).toBeLessThan(4000);

  await sheet.getByRole("button", { name: "Calibrate", exact: true }).click();
  await expect(sheet.getByText(/^The fit holds/)).toBeVisible();
  const mass = sheet
    .getByRole("row", { name: /^Mass over nominal/ })
    .getByRole("cell")
    .first();
  expect(Number(await mass.textContent())).toBeCloseTo(1.04, 2);
  await sheet.getByRole("button", { name: "Diagnose" }).click();
  const verdicts = sheet.getByRole("list", { name: "Verdicts of kalman" });
  await expect(verdicts.getByRole("listitem").last()).toContainText("m+10");
  await expect(verdicts.getByRole("listitem").filter({ hasText: "healthy" }).first()).toBeVisible();

  await sheet.getByRole("button", { name: "Open on a bench" }).click();
  await expect(sheet).toBeHidden();
  await expect(page.getByRole("region", { name: "Record" })).toContainText("It has no labels");
  await expect(page.getByTestId("bench-state")).toHaveText("running");
});
