import { expect, test } from "./lab";

const GOOD = `schema = 1
id = "quiet"
title = "A quiet bench of mine"
sample_rate_khz = 100
device.id = "ch3"
plant.model = "linear"
reference = { kind = "sine", amplitude_v = 5.0, frequency_hz = 1500.0 }
controller = { kind = "open_loop" }
sensor = { kind = "ideal", noise_um = 0.02 }
`;
const file = (name: string, text: string) => ({ name, mimeType: "application/toml", buffer: Buffer.from(text) });

test("a scenario from disk is opened, refused at the field, and kept under Mine", async ({ page, openBench }) => {
  await openBench("lab");
  await page.keyboard.press("n");
  await page.getByRole("button", { name: "Open a scenario from disk" }).click();
  const sheet = page.getByRole("dialog", { name: "Mine" });
  await expect(sheet.getByText("Nothing kept yet")).toBeVisible();
  const choose = (text: string, name = "mine.toml") =>
    sheet.locator("input[type=file]").setInputFiles(file(name, text));

  await choose(GOOD.replace("noise_um", "noise_nm"));
  await expect(sheet.getByRole("alert")).toContainText("mine.toml cannot be opened: sensor.noise_nm");
  await choose("nonsense", "words.toml");
  await expect(sheet.getByRole("alert")).toContainText("words.toml cannot be opened");
  await sheet.getByTestId("drop").evaluate((zone, text) => {
    const data = new DataTransfer();
    data.items.add(new File([text], "dropped.toml"));
    zone.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  }, GOOD);
  await expect(page.getByRole("button", { name: /^A quiet bench of mine/ })).toBeVisible();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await expect(sheet).toBeHidden();

  await page.getByRole("button", { name: "Gallery", exact: true }).click();
  await page.getByRole("button", { name: "Mine, or from disk" }).click();
  await sheet.getByRole("button", { name: "Rename A quiet bench of mine" }).click();
  await sheet.getByLabel("New title of").fill("Quieter");
  await sheet.getByLabel("New title of").press("Enter");
  await sheet.getByRole("button", { name: "Open Quieter" }).click();
  await expect(sheet).toBeHidden();
  await expect(page.getByTestId("bench-state")).toHaveText("running");

  page.on("dialog", (question) => question.accept());
  await page.keyboard.press("n");
  await page.getByRole("button", { name: "Open a scenario from disk" }).click();
  await sheet.getByRole("button", { name: "Delete Quieter" }).click();
  await expect(sheet.getByText("Nothing kept yet")).toBeVisible();
});
