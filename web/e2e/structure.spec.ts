import { expect, test } from "./lab";

const SINE = { kind: "sine", amplitude_v: 5, frequency_hz: 2000 };

test("the loop is drawn after the figure whose parts are on the bench", async ({ page, openDocument, server }) => {
  const id = await openDocument({
    device: { id: "lcr-350" },
    reference: SINE,
    controller: { kind: "mrac" },
    sensor: { kind: "ideal" },
  });
  const drawing = (figure: string) => page.getByRole("group", { name: new RegExp(`as in figure ${figure}$`) });
  const box = (figure: string, name: RegExp) => drawing(figure).getByRole("button", { name });

  await expect(box("3.1.2.1.1", /^Adaptation gains, by ε/)).toBeVisible();
  await expect(box("3.1.2.1.1", /^Augmentation error η/)).toBeVisible();
  await expect(page.getByText("drawn as figure 3.1.2.1.1")).toBeVisible();
  // what adapts is the controller: its card has the equations
  await box("3.1.2.1.1", /^Augmentation/).press("Enter");
  await expect(page.getByRole("heading", { name: "Direct MRAC" })).toBeVisible();

  const drive = (name: string) => server.ask("POST", `/benches/${id}/commands`, { switch: name });
  await drive("mrac_velocity");
  await expect(box("2.2.1", /^Adaptation gains, by e:/)).toBeVisible();
  await drive("indirect_mrac");
  await expect(box("3.3.2.1", /^Identifier Least squares/)).toBeVisible();
  await expect(box("3.3.2.1", /^Gain design/)).toBeVisible();
  await drive("stvsc");
  await expect(box("2.2.3.1", /^Identifier Gradient/)).toBeVisible();

  // a fault has no room below the device here, so it is named below the drawing
  await server.ask("POST", `/benches/${id}/commands`, { fault: "added_mass", severity: 0.05 });
  await expect(page.getByRole("region", { name: "The loop" })).toContainText("Added mass");

  await server.ask("POST", `/benches/${id}/commands`, { set: { "sensor.kind": "single_beam" } });
  await expect(box("3.2.6.1", /^Light Through wafer/)).toBeVisible();
  await expect(box("3.2.6.1", /^Photodiode/)).toBeVisible();
  await expect(box("3.2.6.1", /^Recovery unit/)).toBeVisible();
  await expect(box("3.2.6.1", /^Device, grating/)).toBeVisible();

  await server.ask("POST", `/benches/${id}/commands`, { set: { "sensor.kind": "ideal" } });
  await drive("pid");
  await expect(
    page.getByRole("group", { name: "Signal flow from the reference around the loop", exact: true }),
  ).toBeVisible();
});
