import type { Locator, Page } from "@playwright/test";
import katex from "katex";
import { expect, front, test } from "../lab";
import type { LabServer } from "../lab-server";

const TRUE_DEG_S = 100;
const BENCH = {
  title: "Gyroscope",
  plant: { model: "gyroscope" },
  rate: { kind: "constant", deg_per_s: TRUE_DEG_S },
  controller: { kind: "force_to_rebalance" },
};

/** The faults a bank knows, and the hypothesis it must come to. */
const KNOWN = [
  ["Quadrature", /^quadrature \+500\s/],
  ["Loss of drive", /^drive gain −50\s%$/],
  ["Stiffness of the sensing axis", /^stiffness along y \+1\s%$/],
  ["Leak of the package", /^damping \+100\s%$/],
] as const;

/** Faults that any device may have. */
const COMMON = [
  "Added mass",
  "Ageing",
  "Beam stiffness",
  "Damping",
  "Sensor bias",
  "Sensor drop-out",
  "Sensor hum",
  "Sensor noise",
  "Sensor quantisation",
  "Shock",
];

const DRIVE = ["Waveform drive", "Drive tracking", "Forced drive", "Drive loop (amplitude and phase)"];
const SENSE = [
  "Force to rebalance",
  "Sense-axis synchronisation",
  "Many-input adaptive control",
  "Whole-angle read-out",
];

const legend = (page: Page, signal: string) => page.getByRole("region", { name: new RegExp(`^Scope: ${signal}`) });

/** The number a scope shows beside a signal. */
const reading = async (scope: Locator, name: string): Promise<number> =>
  Number(new RegExp(`${name}\\s+(−?[\\d.]+)`).exec(await scope.innerText())?.[1].replace("−", "-"));

/** Look again and again, each time a second later. */
const later = <T>(server: LabServer, look: () => Promise<T>) =>
  expect.poll(async () => {
    await server.advance(1);
    return look();
  });

test("four faults of a gyroscope are injected, found and healed from the page", async ({
  page,
  server,
  openDocument,
}) => {
  const id = await openDocument({ ...BENCH, device: { id: "gyro-a" }, diagnosers: { bank: { kind: "axes_bank" } } });
  await server.ask("POST", `/benches/${id}/commands`, { kind: "time_scale", value: 0.1 });
  await page.getByRole("tab", { name: "Faults" }).click();
  await page.getByRole("tab", { name: "Diagnosis" }).click();
  const faults = page.locator("section[aria-label='Faults']");
  const says = page.getByRole("region", { name: "Diagnosis by bank" }).locator("dd").first();
  for (const [title, hypothesis] of KNOWN) {
    await later(server, () => says.innerText()).toBe("healthy");
    await faults.getByRole("button", { name: new RegExp(`^Inject .*: ${title}$`) }).click();
    await expect(faults.getByText(/^1\sactive fault$/)).toBeVisible();
    await later(server, () => says.innerText()).toMatch(hypothesis);
    await faults.getByRole("listitem").filter({ hasText: title }).getByRole("button", { name: "Heal" }).click();
    await expect(faults.getByText("The device is healthy")).toBeVisible();
  }

  // why, in numbers: two residuals for each hypothesis, weighed together
  await page.getByRole("region", { name: "Diagnosis by bank" }).locator("canvas").click({ force: true });
  const why = page.getByRole("region", { name: "Why" });
  await expect(why.getByRole("columnheader", { name: "Residual along x, y" })).toBeVisible();
  await expect(why.getByRole("row", { name: /^healthy.*m.*m.*%/ })).toBeVisible();
  await expect(why.getByText("the winner raised by the least evidence")).toBeVisible();

  // the device the adaptive law is tuned for; it drives both axes
  await front(page, "Controller", "Choice");
  const controllers = page.locator("section[aria-label='Choice']");
  await controllers.getByRole("radio", { name: "Adaptive control with rate estimate" }).click();
  await expect(controllers.getByText("Waits: Adaptive control with rate estimate")).toBeVisible();
  await page.getByRole("tab", { name: "Angular rate" }).click();
  // beside Why the scope has room for the names alone
  await page.locator(".dv-active-group").getByRole("button", { name: "Fill the page with this panel" }).click();
  const estimate = () => reading(legend(page, "rate.rate"), "adaptive rate");
  await later(server, async () => Math.abs((await estimate()) - TRUE_DEG_S)).toBeLessThan(50);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
});

test("a loop makes something of a fault, and controllers take over from the page and drive", async ({
  page,
  openDocument,
  server,
}) => {
  const waveform = { kind: "sine", amplitude_v: 1, frequency_hz: 3925 };
  const id = await openDocument({ ...BENCH, device: { id: "gyro-c" }, waveform });
  await server.ask("POST", `/benches/${id}/commands`, { kind: "time_scale", value: 0.5 });
  const rate = () => reading(legend(page, "rate.rate"), "force to rebalance rate");
  await later(server, rate).toBeCloseTo(TRUE_DEG_S, -1);

  // half the comb that rebalances is shorted: the loop asks for twice the force and reads twice the rate
  await page.getByRole("tab", { name: "Faults" }).click();
  const faults = page.locator("section[aria-label='Faults']");
  const shorted = faults.getByRole("listitem").filter({ hasText: "Shorted finger pairs" });
  await shorted.getByRole("button", { name: "Shorted finger pairs", exact: true }).click();
  await shorted.getByRole("textbox", { name: "Severity of Shorted finger pairs, exact" }).fill("50");
  await shorted.getByRole("button", { name: /^Inject \+50 pairs$/ }).click();
  await later(server, rate).toBeCloseTo(2 * TRUE_DEG_S, -1);
  await faults.getByRole("button", { name: "Heal all" }).click();
  await later(server, rate).toBeCloseTo(TRUE_DEG_S, -1);

  // a spring between the axes is read as quadrature, in addition to the device's own, and not as a rate
  await page.getByRole("tab", { name: "Quadrature" }).click();
  const quadrature = () =>
    reading(legend(page, "(@active|force_to_rebalance).quadrature"), "force to rebalance quadrature");
  await later(server, quadrature).toBeGreaterThan(0);
  const before = await quadrature();
  await faults.getByRole("button", { name: /^Inject \+500 deg\/s: Quadrature$/ }).click();
  await later(server, quadrature).toBeCloseTo(before + 500, -1);
  await front(page, "Angular rate");
  await later(server, rate).toBeCloseTo(TRUE_DEG_S, -1);
  await faults.getByRole("button", { name: "Heal all" }).click();
  await expect(faults.getByText("The device is healthy")).toBeVisible();

  await page.getByRole("tab", { name: "Forces" }).click();
  await front(page, "Controller", "Choice");
  const panel = page.locator("section[aria-label='Choice']");
  const force = (axis: string) => () => reading(legend(page, "drive.x.force"), `drive ${axis} force`);
  const choose = async (title: string) => {
    const choice = panel.getByRole("radio", { name: title });
    await choice.click();
    await expect(choice).toBeChecked();
  };
  // some saturate the drive in the long run and trip; a slow page must not give them that time
  await server.ask("POST", `/benches/${id}/commands`, { kind: "time_scale", value: 0.02 });
  for (const title of DRIVE) {
    await choose(title);
    await later(server, force("x")).not.toBe(0);
  }
  for (const title of SENSE) {
    await choose("Open-loop read-out");
    await later(server, force("y")).toBe(0);
    await choose(title);
    await later(server, force("y")).not.toBe(0);
  }
  await expect(panel.getByText("Waits: Whole-angle read-out")).toBeVisible();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
});

test("a rate that the motion does not tell is not trusted; the faults of any device act on a gyroscope", async ({
  page,
  openDocument,
  server,
}) => {
  const alike = { frequency_x_hz: 663.676, frequency_y_hz: 663.676 };
  const rate = { kind: "constant", deg_per_s: 5000 };
  const id = await openDocument({ ...BENCH, device: { id: "gyro-a" }, rate, controllers: { adaptive_rate: alike } });
  await front(page, "Controller", "Choice");
  const controllers = page.locator("section[aria-label='Choice']");
  const adaptive = page.getByRole("radio", { name: "Adaptive control with rate estimate" });
  const row = controllers.locator("[data-active='true']").filter({ has: adaptive });
  await adaptive.click();
  await server.advance(2);
  await expect(row).toContainText("not trusted");
  await front(page, "Log", "Events");
  await expect(page.getByText(/^adaptive_rate: not persistently exciting/)).toBeVisible();
  // another frequency along y, from its card, and the rate is found
  await controllers.getByRole("button", { name: "Parameters" }).last().click();
  await page.getByRole("textbox", { name: "Frequency y, Hz" }).fill("813.282");
  await page.keyboard.press("Enter");
  await front(page, "Controller", "Choice");
  await server.advance(2);
  await expect(row).not.toContainText("not trusted");
  // after 0.19 s at this rate, y swings past the travel when force to rebalance stops holding it: let little time pass
  await server.ask("POST", `/benches/${id}/commands`, { kind: "time_scale", value: 0.0005 });
  // a loop that goes after the resonance would lose it to ageing, and push too hard when that is healed
  await controllers.getByRole("radio", { name: "Drive tracking" }).click();
  await controllers.getByRole("radio", { name: "Open-loop read-out" }).click();

  await page.getByRole("tab", { name: "Faults" }).click();
  const faults = page.locator("section[aria-label='Faults']");
  for (const title of COMMON) {
    await faults.getByRole("button", { name: new RegExp(`^Inject .*: ${title}$`) }).click();
    await expect(faults.getByText(/^1\sactive fault$/)).toBeVisible();
    await faults.getByRole("listitem").filter({ hasText: title }).getByRole("button", { name: "Heal" }).click();
    await expect(faults.getByText("The device is healthy")).toBeVisible();
  }
  await expect(page.getByTestId("bench-state")).toHaveText("running");
});

test("of two gyroscopes one is made to swing as the other", async ({ page, server, openDocument }) => {
  await openDocument({
    title: "Two gyroscopes",
    device: { id: "gyro-4-5" },
    plant: { model: "gyroscope_pair", partner: { id: "gyro-2-2" } },
    slots: { drive: "drive_tracking" },
    controller: { kind: "open_loop_rate" },
  });
  const tilt = page.getByTestId("tilt");
  const first = () => tilt.first().innerText();
  const last = () => tilt.last().innerText();
  await later(server, first).toMatch(/^(4\.00|3\.99)/);
  await later(server, last).toMatch(/^(2\.00|1\.99)/);
  await front(page, "Controller", "Choice");
  await page.getByRole("radio", { name: "Sense-axis synchronisation" }).click();
  await later(server, first).toMatch(/^(2\.00|1\.99)/);
  await later(server, last).toMatch(/^(2\.00|1\.99)/);
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
