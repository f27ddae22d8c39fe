import { readFileSync } from "node:fs";
import type { Locator, Page } from "@playwright/test";
import { expect, front, HYPOTHESES, inWords, openPanel, pictureOf, test } from "../lab";

test.use({ colorScheme: "dark" });

/** Save the content of a panel, as a user does. */
async function keep(page: Page, within: Locator, kind: "PNG" | "SVG"): Promise<Buffer> {
  await within
    .getByRole("button", { name: /^Export/ })
    .first()
    .click();
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("menuitem", { name: kind, exact: true }).click(),
  ]);
  expect(download.suggestedFilename()).toMatch(new RegExp(`^[a-z0-9-]+\\.${kind.toLowerCase()}$`));
  return readFileSync(await download.path());
}

/** Read a drawing with a browser that has no page around it: its text, and its faults. */
async function examine(page: Page, svg: string) {
  const sheet = await page.context().newPage();
  await sheet.setContent(svg);
  const found = await sheet.evaluate((text) => {
    const parsed = new DOMParser().parseFromString(text, "image/svg+xml");
    const wrong: string[] = parsed.querySelector("parsererror") ? ["it is no XML"] : [];
    const root = document.querySelector("svg") as SVGSVGElement;
    for (const node of Array.from(root.querySelectorAll("*")))
      for (const { name, value } of Array.from(node.attributes))
        if (/NaN|Infinity|undefined|var\(|null/.test(value)) wrong.push(`${node.nodeName} ${name}="${value}"`);
    for (const path of Array.from(root.querySelectorAll("path")))
      if (!path.getAttribute("d")) wrong.push("an empty path");
    const { width, height, left, top } = root.getBoundingClientRect();
    for (const node of Array.from(root.querySelectorAll("text"))) {
      const box = node.getBoundingClientRect();
      const outside = box.left < left || box.top < top || box.right > left + width || box.bottom > top + height;
      if (outside) wrong.push(`"${node.textContent}" lies outside`);
    }
    const curves = Array.from(root.querySelectorAll("path"), (path) => path.getTotalLength());
    return {
      wrong,
      texts: Array.from(root.querySelectorAll("text"), (t) => t.textContent ?? ""),
      longest: Math.max(...curves),
    };
  }, svg);
  await sheet.close();
  expect(found.wrong).toEqual([]);
  // more than grid lines
  expect(found.longest).toBeGreaterThan(400);
  return found.texts;
}

const svgOf = async (page: Page, within: Locator) => examine(page, (await keep(page, within, "SVG")).toString());

test("spectrum, phase plane and lanes are kept with titled axes, and lanes with their events", async ({
  page,
  openBench,
  server,
}) => {
  await openBench("lab");
  const scope = async (view: string) => {
    await openPanel(page, view);
    return page.getByRole("region", { name: view, exact: true });
  };
  const lanes = page.getByRole("region", { name: "Diagnosis by kalman" });
  await page.getByRole("button", { name: /^Inject \+5.*Added mass$/ }).click();
  await expect(page.getByText(/^1\sactive fault$/)).toBeVisible();
  await server.advance(4);
  await expect(lanes.getByText(/^mass \+5/).first()).toBeVisible();
  const told = await svgOf(page, lanes);
  expect(told).toEqual(expect.arrayContaining(["probability of each hypothesis, 0 to 1", "time of the device, ms"]));
  expect(told).toEqual(expect.arrayContaining(HYPOTHESES.map(({ name }) => inWords(name))));
  expect(told.some((text) => /^at [\d\s.]+\sms: .*mass/i.test(text))).toBe(true);

  const spectrum = await scope("Spectrum");
  await expect(spectrum.getByText(/^Strongest/)).toBeVisible();
  expect(await svgOf(page, spectrum)).toEqual(
    expect.arrayContaining(["frequency, kHz", "amplitude", "1\u00a0µm", "100\u00a0nm"]),
  );
  const png = await keep(page, spectrum, "PNG");
  expect(png.subarray(1, 4).toString()).toBe("PNG");
  // twice the pixels of the drawing, from the header
  expect(png.readUInt32BE(16)).toBe(2 * 960);

  const phase = await scope("Phase plane");
  await phase.getByRole("button", { name: "Use the planar plant" }).click();
  await expect(phase.getByRole("button", { name: "Use the planar plant" })).toHaveCount(0);
  await server.advance(1); // the map belongs to a plant that has run
  await expect(phase.getByText(/a slow drive folds/)).toBeVisible();
  const plane = await svgOf(page, phase);
  expect(plane).toContain("unstable");
  expect(plane).toEqual(expect.arrayContaining([expect.stringMatching(/^plant displacement, [nµ]m$/)]));
  expect(plane).toEqual(expect.arrayContaining([expect.stringMatching(/^plant velocity, [mµ]?m\/s$/)]));
});

test("Bode diagrams, charts of a campaign and plots of theory are kept, in light colours from a dark page", async ({
  page,
  openBench,
  server,
}) => {
  await openBench("lab");
  await page.keyboard.press("g");
  await expect(page.getByRole("img", { name: /^Bode diagram/ })).toBeVisible();
  const bode = (await keep(page, page.locator("section", { hasText: "Frequency response" }).last(), "SVG")).toString();
  expect(await examine(page, bode)).toEqual(
    expect.arrayContaining(["magnitude re static, dB", "phase, °", "frequency, Hz", "This device"]),
  );
  expect(bode).toContain('stroke="#0072b2"');
  expect(bode).not.toMatch(/#56b4e9|#262e37|#e8ecf1/i);

  await page.keyboard.press("t");
  await page.getByRole("tab", { name: "Positive real" }).click();
  const real = page.getByRole("region", { name: "Positive real" });
  await expect(real.getByRole("img", { name: /^Real part/ })).toBeVisible();
  expect(await svgOf(page, real)).toEqual(expect.arrayContaining(["ω, rad per unit of time", "Re G(jω)", "Im G(jω)"]));
  await page.getByRole("tab", { name: "Stability" }).click();
  const map = page.getByRole("region", { name: "Instability map" });
  await expect(map.getByText(/of the map is unstable/)).toBeVisible();
  expect(await svgOf(page, map)).toContain("adaptation gain");

  const { id } = await server.ask<{ id: string }>("POST", "/sweeps", {
    sweep: {
      schema: 1,
      scenario: "ch5-seven-step",
      seeds: "1:2",
      grid: { "sensor.noise_um": [0.05, 0.2] },
    },
  });
  const state = () => server.ask<{ state: string }>("GET", `/sweeps/${id}`).then((found) => found.state);
  await expect.poll(state).toBe("done");
  await page.goto(`${server.origin}/?page=runs&sweep=${id}`);
  const chart = page.getByRole("figure").filter({ hasText: "Detection delay" });
  expect(await svgOf(page, chart)).toEqual(expect.arrayContaining(["delay, samples", "share found by then"]));
});

test("pictures of a race, adaptation, aliases and a swept sine are saved", async ({ page, openBench, server }) => {
  await openBench("lab", { "diagnosers.imm": { kind: "imm", hypotheses: HYPOTHESES } });
  const viewOf = async (panel: string, view: string) => {
    await front(page, panel, view);
    return page.getByRole("region", { name: view, exact: true });
  };
  const race = page
    .locator("div", { has: page.getByRole("combobox", { name: "Diagnosers shown" }) })
    .filter({ has: page.getByText("LIVE", { exact: true }) })
    .last();
  await expect(page.getByRole("region", { name: "Diagnosis by imm" })).toBeAttached();
  await server.advance(1);
  await page.waitForFunction(() => document.querySelectorAll("canvas[aria-label$='over time']").length >= 3);
  const field = await svgOf(page, race);
  expect(field).toEqual(expect.arrayContaining(["truth", "kalman", "imm", "time of the device, ms"]));
  expect(field).toContain("probabilities, stacked from 0 to 1");

  const adaptation = await viewOf("Controller", "Adaptation");
  const canvas = "section[aria-label='Adaptation'] canvas";
  const blank = await pictureOf(page, canvas);
  await server.advance(1);
  await expect.poll(() => pictureOf(page, canvas)).not.toBe(blank);
  expect(await svgOf(page, adaptation)).toEqual(expect.arrayContaining(["now", "ideal", "time of the device, ms"]));

  const hypotheses = await viewOf("Diagnosis", "Hypotheses");
  await expect(hypotheses.getByRole("img", { name: /in the complex plane/ })).toBeVisible();
  expect(await svgOf(page, hypotheses)).toEqual(
    expect.arrayContaining(["real part of the motion", "distance of the closest pair"]),
  );

  await front(page, "Frequency response");
  const sweep = page.getByRole("region", { name: "Frequency response", exact: true });
  await sweep.getByRole("button", { name: "Sweep the device" }).click();
  await expect(sweep.getByRole("row", { name: /^Resonance/ })).toBeVisible();
  expect(await svgOf(page, sweep)).toEqual(expect.arrayContaining(["magnitude re static, dB", "frequency, Hz"]));
});
