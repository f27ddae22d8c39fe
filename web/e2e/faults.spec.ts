import { expect, test } from "./lab";

test("an injected fault is found, the delay is printed, and healing clears it", async ({ page, server, openBench }) => {
  await openBench();
  const lanes = page.getByRole("region", { name: "Diagnosis by kalman" });
  await server.advance(2);
  await expect(lanes.getByText("healthy", { exact: true })).toBeVisible();
  await page.getByRole("button", { name: /^Inject \+5.*Added mass$/ }).click();
  await expect(page.getByText("1 fault acts")).toBeVisible();
  await server.advance(5);
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
