import type { Page } from "@playwright/test";
import { benchOf } from "./classroom";
import { expect, front, test } from "./lab";
import type { LabServer } from "./lab-server";

interface Device {
  geometry?: Record<string, number>;
}

const figuresOf = (page: Page) => page.getByRole("region", { name: "Figures" });

async function enter(page: Page, field: string, value: string): Promise<void> {
  const box = page.getByRole("textbox", { name: field }).first();
  await box.fill(value);
  await box.press("Enter");
}

/** Put the design on a bench; the device of that bench. */
async function useOnBench(page: Page, server: LabServer, title: RegExp): Promise<Device> {
  const before = benchOf(page);
  await page.getByRole("button", { name: "Use on the bench" }).click();
  await expect(page.getByRole("button", { name: title })).toBeVisible();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  expect(benchOf(page)).not.toBe(before);
  const made = await server.ask<{ parameters: { device: Device } }>("GET", `/benches/${benchOf(page)}`);
  return made.parameters.device;
}

test("a resonator and a gyroscope are designed, and put on a bench", async ({ page, openBench, server }) => {
  await openBench();
  await page.keyboard.press("g");
  await expect(figuresOf(page).getByText("2.484 kHz")).toBeVisible();
  await expect(page.getByRole("img", { name: /from above, to scale/ })).toBeVisible();
  // half the length: k goes with 1/L^3 and there is less beam to move, so f0 rises by more than the root of eight
  await enter(page, "Beam length, µm", "175");
  await expect(figuresOf(page).getByText(/^7\.\d+\skHz$/)).toBeVisible();
  await page.getByRole("button", { name: "Draw one from the process" }).click();
  await expect(page.getByText(/device 1 of the process/)).toBeVisible();
  await page.getByRole("button", { name: "Back to the drawing" }).click();
  await enter(page, "Etch bias per edge, µm", "1.2");
  await expect(page.getByRole("alert").filter({ hasText: "nothing is left of the beams" })).toBeVisible();
  await expect(page.getByRole("button", { name: "Use on the bench" })).toBeDisabled();
  await enter(page, "Etch bias per edge, µm", "0.2");
  const { geometry } = await useOnBench(page, server, /^Designed: LCR-350/);
  expect(geometry).toEqual({ beam_length_um: 175, beam_bias_um: 0.2 });

  await page.keyboard.press("g");
  await page.getByRole("combobox", { name: "Device" }).selectOption("gyro-lcr-350");
  const split = figuresOf(page).locator("div", { hasText: /^Split of the modes/ });
  await expect(split).toContainText("145.0\u00a0Hz");
  // f goes with the root of 1/L^3, so 20 um off 350 split the modes by 9 % of 3.3 kHz
  await enter(page, "Beam length along y, µm", "330");
  await expect(split).toContainText(/30\d\.\d\u00a0Hz/);
  await enter(page, "Fingers per side along y", "88");
  await expect(page.getByRole("alert").filter({ hasText: "88 fingers along y take 698 µm" })).toBeVisible();
  await enter(page, "Fingers per side along y", "60");
  expect(await useOnBench(page, server, /^Designed: Gyroscope with the beams/)).toMatchObject({
    drawn_gyroscope: { sense_beam_length_um: 330, sense_fingers: 60 },
  });
});

test("a gyroscope has its loops and its tilt, and its fault is injected, found and healed", async ({
  page,
  server,
  openDocument,
}) => {
  const id = await openDocument({
    title: "Gyroscope",
    device: { id: "gyro-a" },
    plant: { model: "gyroscope" },
    rate: { kind: "constant", deg_per_s: 100 },
    controller: { kind: "force_to_rebalance" },
    diagnosers: { bank: { kind: "axes_bank" } },
  });
  await server.ask("POST", `/benches/${id}/commands`, { kind: "time_scale", value: 0.1 });
  await page.getByRole("tab", { name: "Faults" }).click();
  await page.getByRole("tab", { name: "Diagnosis" }).click();
  const faults = page.locator("section[aria-label='Faults']");
  const says = page.getByRole("region", { name: "Diagnosis by bank" }).locator("dd").first();
  await server.advance(1);
  await expect(says).toHaveText("healthy");
  await faults.getByRole("button", { name: /^Inject .*: Quadrature$/ }).click();
  await expect(faults.getByText(/^1\sactive fault$/)).toBeVisible();
  await server.advance(3);
  await expect(says).toHaveText(/^quadrature \+500\s/);
  await faults.getByRole("listitem").filter({ hasText: "Quadrature" }).getByRole("button", { name: "Heal" }).click();
  await expect(faults.getByText("The device is healthy")).toBeVisible();
  await server.advance(3);
  await expect(says).toHaveText("healthy");

  await front(page, "Controller");
  const panel = page.getByRole("region", { name: "Choice" });
  await panel.getByRole("radio", { name: "Whole-angle read-out" }).click();
  await expect(panel.getByText("Waits: Whole-angle read-out")).toBeVisible();
  await panel.getByLabel("Kind of angular rate").selectOption("sine");
  await expect(panel.getByText("Frequency", { exact: true })).toBeVisible();
  const bench = await server.ask<{ parameters: { rate: { kind: string } }; slots: object }>("GET", `/benches/${id}`);
  expect(bench.parameters.rate.kind).toBe("sine");
  expect(bench.slots).toMatchObject({ sense: "whole_angle" });
});
