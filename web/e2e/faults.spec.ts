import type { Page } from "@playwright/test";
import { expect, front, test } from "./lab";

const lanesOf = (page: Page) => page.getByRole("region", { name: "Diagnosis by kalman" });

test("an injected fault is found and explained, the delay is printed, and healing clears it", async ({
  page,
  server,
  openBench,
}) => {
  await openBench();
  const lanes = lanesOf(page);
  await server.advance(2);
  await expect(lanes.getByText("healthy", { exact: true })).toBeVisible();
  await page.getByRole("button", { name: /^Inject \+5.*Added mass$/ }).click();
  await expect(page.getByText(/^1\sactive fault$/)).toBeVisible();
  await server.advance(5);
  await expect(lanes.getByText(/^mass \+5\s%$/)).toBeVisible();
  await expect(lanes.getByText(/^\d+\ssamples · [1-9]\d{0,2}(\.\d+)?\s(µs|ms)$/)).toBeVisible();

  await page.getByRole("button", { name: "Explain the newest sample" }).click();
  const why = page.getByRole("region", { name: "Why" });
  await expect(why.getByText(/^Mass \+5\s% (wins|stays ahead)/)).toBeVisible();
  await expect(why.getByRole("row")).toHaveCount(7);
  await why.getByRole("button", { name: "The sample where it turned" }).click();
  await expect(why.getByText(/The verdict turned at this sample, from /)).toBeVisible();

  await front(page, "Log", "Events");
  await expect(page.getByRole("button", { name: /kalman found m\+5 after \d+\ssamples/ })).toBeVisible();
  await page.getByRole("button", { name: /^\d.*inject added_mass/ }).click();
  const past = page.getByRole("button", { name: "PAST → LIVE" });
  await expect(past.first()).toBeVisible();
  await page.keyboard.press("l");
  await expect(past).toHaveCount(0);

  await page.getByRole("tab", { name: "Faults" }).click();
  await page.getByRole("button", { name: "Heal all" }).click();
  await expect(page.getByText("The device is healthy")).toBeVisible();
});

test("a fault is set exactly and waits for its moment; a fault outside the hypotheses is marked as such", async ({
  page,
  server,
  openBench,
}) => {
  await openBench();
  const faults = page.getByRole("region", { name: "Faults", exact: true });
  await faults.getByRole("button", { name: "Damping", exact: true }).click();
  const exact = faults.getByRole("textbox", { name: "Severity of Damping, exact" });
  await faults.getByRole("slider", { name: "Severity of Damping" }).focus();
  await page.keyboard.press("ArrowRight");
  await expect(exact).toHaveValue("31 %");
  await exact.fill("5000");
  await expect(faults.getByText("At most +2000\u00a0%")).toBeVisible();
  await exact.fill("55");
  await faults.getByText("on a condition").click();
  await faults.getByRole("combobox", { name: "When" }).selectOption("plant displacement");
  const level = faults.getByRole("textbox", { name: "Level" });
  await level.fill("");
  await faults.getByRole("button", { name: /Let it wait/ }).click();
  await expect(faults.getByText("Say at what value")).toBeVisible();
  await level.fill("0.5");
  await faults.getByRole("button", { name: /Let it wait/ }).click();
  const steps = page.getByRole("region", { name: "Steps of the scenario" });
  await expect(steps).toContainText(/2 of 2: Damping \+55\s%, when plant displacement > 500\snm/);
  await server.advance(3);
  await expect(faults.getByText(/^1\sactive fault$/)).toBeVisible();
  await faults.getByRole("button", { name: "Heal all" }).click();
  await expect(faults.getByText("The device is healthy")).toBeVisible();

  await faults.getByRole("button", { name: "Added mass", exact: true }).click();
  await faults.getByRole("textbox", { name: "Severity of Added mass, exact" }).fill("900");
  await faults.getByRole("button", { name: /^Inject \+900.*Added mass$/ }).click();
  await expect(faults.getByText(/^1\sactive fault$/)).toBeVisible();
  await server.advance(5);
  await expect(lanesOf(page).getByText("fits none")).toBeVisible();
  await expect(lanesOf(page).getByText("not among the hypotheses")).toBeVisible();
});
