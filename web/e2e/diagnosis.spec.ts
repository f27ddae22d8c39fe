import { expect, test } from "./lab";

test("an injected fault is found, the delay is printed, and healing clears it", async ({ page, openBench }) => {
  await openBench();
  const lanes = page.getByRole("region", { name: "Diagnosis by kalman" });
  await expect(lanes.getByText("healthy", { exact: true })).toBeVisible();
  await page.getByRole("button", { name: /^Inject \+5.*Added mass$/ }).click();
  await expect(page.getByText("1 fault acts")).toBeVisible();
  await expect(lanes.getByText(/^mass \+5\s%$/)).toBeVisible();
  await expect(lanes.getByText(/^\d+\ssamples · [1-9]\d{0,2}(\.\d+)?\s(µs|ms)$/)).toBeVisible();

  await page.getByRole("tab", { name: "Events" }).click();
  await expect(page.getByRole("button", { name: /kalman found m\+5 after \d+\ssamples/ })).toBeVisible();
  await page.getByRole("button", { name: /^\d.*inject added_mass/ }).click();
  await expect(page.getByRole("button", { name: "LIVE" }).first()).toHaveAttribute("aria-pressed", "false");
  await page.keyboard.press("l");
  await expect(page.getByRole("button", { name: "LIVE" }).first()).toHaveAttribute("aria-pressed", "true");

  await page.getByRole("button", { name: "Heal all" }).click();
  await expect(page.getByText("The device is healthy")).toBeVisible();
});

test("a fault can be set exactly and wait for its moment", async ({ page, openBench }) => {
  await openBench();
  const faults = page.getByRole("region", { name: "Faults", exact: true });
  const groups = faults.getByRole("heading", { level: 3 });
  await expect(groups.first()).toHaveText("The usual");
  await expect(groups.last()).toHaveText("Surroundings");
  await page.getByRole("button", { name: "Damping", exact: true }).click();
  const exact = faults.getByRole("textbox", { name: "Severity of Damping, exact" });
  const slider = faults.getByRole("slider", { name: "Severity of Damping" });
  await slider.focus();
  for (let percent = 31; percent <= 33; percent += 1) {
    await page.keyboard.press("ArrowRight");
    await expect(exact).toHaveValue(`${percent} %`);
  }
  await exact.fill("5000");
  await expect(faults.getByText("At most +2000\u00a0%")).toBeVisible();
  await exact.fill("55");
  await faults.getByText("on a condition").click();
  await faults.getByRole("combobox", { name: "When" }).selectOption("plant displacement");
  const level = faults.getByRole("textbox", { name: "Level" });
  await level.fill("");
  await faults.getByRole("button", { name: /Let it wait/ }).click();
  await expect(faults.getByText("Say at what value")).toBeVisible();
  await level.fill("500");
  await faults.getByRole("button", { name: /Let it wait/ }).click();
  const steps = page.getByRole("region", { name: "Steps of the scenario" });
  await expect(steps).toContainText(/2 of 2: Damping \+55\s%, when plant displacement > 500\sµm/);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
});

test("a fault that no hypothesis describes is called so, by the bank and by the bench", async ({ page, openBench }) => {
  await openBench();
  const lanes = page.getByRole("region", { name: "Diagnosis by kalman" });
  await page.getByRole("button", { name: "Added mass", exact: true }).click();
  await page.getByRole("textbox", { name: "Severity of Added mass, exact" }).fill("900");
  await page.getByRole("button", { name: /^Inject \+900.*Added mass$/ }).click();
  await expect(lanes.getByText("fits none")).toBeVisible();
  await expect(lanes.getByText("not among the hypotheses")).toBeVisible();
  await expect(async () => {
    await page.mouse.move(0, 0);
    await lanes.getByText("fits none").hover();
    await expect(page.getByText(/misses by \d.* times what its filter expects/)).toBeVisible({ timeout: 2000 });
  }).toPass();
  if (process.env.SHOTS) await page.screenshot({ path: `${process.env.SHOTS}/fits-none.png` });

  await page.getByRole("button", { name: "Heal all" }).click();
  await expect(lanes.getByText("fits none")).toBeHidden();
  await expect(lanes.getByText("healthy", { exact: true })).toBeVisible();
});
