import { expect, test } from "./lab";
import { seriousViolations } from "./serious-violations";

test("a device is designed, drawn from the process, and put on a bench", async ({ page, openBench, server }) => {
  await openBench();
  await page.keyboard.press("g");
  const figures = page.getByRole("region", { name: "Figures" });
  await expect(figures.getByText("2.484 kHz")).toBeVisible();
  await expect(page.getByRole("img", { name: /from above, to scale/ })).toBeVisible();
  await seriousViolations(page).then((found) => expect(found).toEqual([]));

  // half the length: k goes with 1/L^3 and there is less beam to move, so f0 rises by more than the root of eight
  const length = page.getByRole("textbox", { name: "Beam length, µm" });
  await length.fill("175");
  await length.press("Enter");
  await expect(figures.getByText(/^7\.\d+\skHz$/)).toBeVisible();

  await page.getByRole("button", { name: "Draw one from the process" }).click();
  await expect(page.getByText(/device 1 of the process/)).toBeVisible();
  await page.getByRole("button", { name: "Back to the drawing" }).click();

  const bias = page.getByRole("textbox", { name: "Etch bias per edge, µm" }).first();
  await bias.fill("1.2");
  await bias.press("Enter");
  await expect(page.getByRole("alert").filter({ hasText: "nothing is left of the beams" })).toBeVisible();
  await expect(page.getByRole("button", { name: "Use on the bench" })).toBeDisabled();
  await bias.fill("0.2");
  await bias.press("Enter");

  await page.getByRole("button", { name: "Use on the bench" }).click();
  await expect(page.getByRole("button", { name: /^Designed: LCR-350/ })).toBeVisible();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  const id = new URL(page.url()).searchParams.get("bench");
  const made = await server.ask<{ parameters: { device: { geometry: Record<string, number> } } }>(
    "GET",
    `/benches/${id}`,
  );
  expect(made.parameters.device.geometry).toEqual({ beam_length_um: 175, beam_bias_um: 0.2 });
  await server.ask("DELETE", `/benches/${id}`);
});

test("a gyroscope is designed from beams and fingers and put on a bench", async ({ page, openBench, server }) => {
  await openBench();
  await page.keyboard.press("g");
  await page.getByRole("combobox", { name: "Device" }).selectOption("gyro-lcr-350");
  const split = page.getByRole("region", { name: "Figures" }).locator("div", { hasText: /^Split of the modes/ });
  await expect(split).toContainText("145.7\u00a0Hz");
  await seriousViolations(page).then((found) => expect(found).toEqual([]));

  // f goes with the root of 1/L^3, so 20 um off 350 split the modes by 9 % of 3.3 kHz
  const length = page.getByRole("textbox", { name: "Beam length along y, µm" });
  await length.fill("330");
  await length.press("Enter");
  await expect(split).toContainText(/30\d\.\d\u00a0Hz/);
  const fingers = page.getByRole("textbox", { name: "Fingers per side along y" });
  await fingers.fill("88");
  await fingers.press("Enter");
  await expect(page.getByRole("alert").filter({ hasText: "88 fingers along y take 698 um" })).toBeVisible();
  await fingers.fill("60");
  await fingers.press("Enter");

  await page.getByRole("button", { name: "Use on the bench" }).click();
  await expect(page.getByRole("button", { name: /^Designed: Gyroscope with the beams/ })).toBeVisible();
  const id = new URL(page.url()).searchParams.get("bench");
  const made = await server.ask<{ parameters: { device: object } }>("GET", `/benches/${id}`);
  expect(made.parameters.device).toMatchObject({
    drawn_gyroscope: { sense_beam_length_um: 330, sense_fingers: 60 },
  });
  await server.ask("DELETE", `/benches/${id}`);
});
