import katex from "katex";
import { expect, pictureOf, test } from "./lab";

const GYROSCOPE = {
  title: "Gyroscope C",
  device: { id: "gyro-c" },
  rate: { kind: "constant", deg_per_s: 100 },
  controller: { kind: "open_loop_rate" },
  readouts: { allan: { kind: "allan" } },
};

test("a gyroscope has its loops, its locus, its rate and the noise of it", async ({ page, openDocument, server }) => {
  const errors: string[] = [];
  page.on("pageerror", (error) => errors.push(error.message));
  await page.setViewportSize({ width: 1600, height: 900 });
  const id = await openDocument(GYROSCOPE);

  await expect(page.getByRole("group", { name: /drive loop and the sense loop/ })).toBeVisible();
  const locus = "section[aria-label='Locus'] canvas";
  const before = await pictureOf(page, locus);
  await expect.poll(() => pictureOf(page, locus)).not.toBe(before);
  // with y free the swing is tilted as the device's figures say
  await expect(page.getByTestId("tilt")).toHaveText(/^−0\.\d+°$/, { timeout: 120_000 });

  const panel = page.getByRole("region", { name: "Controllers" });
  await panel.getByRole("radio", { name: "Force to rebalance" }).click();
  await expect(page.getByRole("combobox", { name: "Sense controller" })).toHaveValue("Force to rebalance");
  await expect(panel.getByRole("radio", { name: "Drive loop (amplitude and phase)" })).toBeChecked();
  await expect(page.locator("section[aria-label^='Scope']").first()).toContainText(/force to rebalance\s*rate/);
  await panel.getByRole("radio", { name: "Whole-angle read-out" }).click();
  await expect(panel.getByText("Waits: Whole-angle read-out")).toBeVisible();

  await panel.getByLabel("Kind of angular rate").selectOption("sine");
  await expect(panel.getByText("Frequency", { exact: true })).toBeVisible();
  const bench = await server.ask<{ parameters: { rate: { kind: string } }; slots: object }>("GET", `/benches/${id}`);
  expect(bench.parameters.rate.kind).toBe("sine");
  expect(bench.slots).toEqual({ drive: "drive_loop", sense: "whole_angle" });

  // what the driving controller hears, and nobody else, stands beside the rate
  await expect(panel.getByLabel("Kind of waveform")).toHaveCount(0);
  await panel.getByRole("radio", { name: "Waveform drive" }).click();
  await panel.getByLabel("Kind of waveform").selectOption("square");
  await expect(panel.getByText("Duty", { exact: true })).toBeVisible();
  await panel.getByRole("radio", { name: "Drive loop (amplitude and phase)" }).click();
  await expect(panel.getByLabel("Kind of waveform")).toHaveCount(0);

  await page.getByRole("tab", { name: "Allan deviation" }).click();
  const allan = page.getByRole("region", { name: "Allan deviation" });
  await allan.getByRole("button", { name: "Gather as fast as possible" }).click();
  const plot = allan.getByRole("img", { name: /over (9|\d\d) averaging times$/ });
  await expect(plot).toBeVisible({ timeout: 120_000 });
  await expect(allan.getByRole("row", { name: /Angle random walk N/ })).toBeVisible();

  await page.getByRole("tab", { name: "Faults" }).click();
  await expect(page.getByText("Added mass", { exact: true })).toBeVisible();
  await expect(page.getByText("Point adhesion", { exact: true })).toHaveCount(0);

  // sealed: of what is around it only the temperature acts
  await page.getByRole("tab", { name: "Environment" }).click();
  await expect(page.getByRole("textbox", { name: "Temperature, K" })).toBeVisible();
  await expect(page.getByRole("textbox", { name: "Pressure, Pa" })).toHaveCount(0);
  expect(errors).toEqual([]);
});

test("every equation of the catalogue can be set", async ({ server }) => {
  interface Card {
    name: string;
    equations: { latex: string; printed: string | null }[];
  }
  const { blocks } = await server.ask<{ blocks: Card[] }>("GET", "/catalog");
  const all = blocks.flatMap(({ name, equations }) =>
    equations.flatMap(({ latex, printed }) =>
      [latex, /[\\^_=]/.test(printed ?? "") ? (printed ?? "") : ""].map((text) => [name, text]),
    ),
  );
  expect(all.length).toBeGreaterThan(100);
  for (const [name, latex] of all)
    expect(() => katex.renderToString(latex, { throwOnError: true, strict: "error" }), name).not.toThrow();
});
