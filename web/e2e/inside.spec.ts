import { expect, test } from "./lab";
import { expectClean, expectReadable, SCHEMES, SCREENS, showOn } from "./screens";

const SEVEN = { id: "ch3", force_n_per_v: 6.375e-9 };
const SINE = { kind: "sine", amplitude_v: 10, frequency_hz: 2000 };

test("controllers and banks are drawn from inside, with values and equations", async ({ page, openDocument }) => {
  await openDocument({
    device: SEVEN,
    reference: SINE,
    controller: { kind: "mrac" },
    sensor: { kind: "ideal", noise_um: 0.01 },
    diagnosers: { kalman: { kind: "mmae" } },
  });
  const drawing = page.getByRole("combobox", { name: "Drawing" });
  await drawing.selectOption({ label: "Controller: Direct MRAC" });
  const stages = page.getByRole("group", { name: "Stages of Direct MRAC" });
  await expect(stages.getByRole("button")).toHaveText([
    "State filters",
    "Copies of the model",
    "Error",
    "Augmentation",
    "Augmented error",
    "Adaptation",
    "Law",
    "Lyapunov function",
  ]);
  // a value moves on its line
  const voltage = () =>
    stages
      .getByText(/^−?[\d.]+\sm?V$/)
      .first()
      .textContent();
  const before = await voltage();
  await expect.poll(voltage).not.toBe(before);
  // the equations of a stage, by the keyboard
  await stages.getByRole("button", { name: "Adaptation" }).press("Enter");
  const equations = page.getByRole("region", { name: "Equations: Adaptation" });
  await expect(equations).toContainText("3.1.2.15-16");
  await expect(equations.locator(".katex").first()).toBeVisible();

  await drawing.selectOption({ label: "Diagnosis: Kalman bank (MMAE)" });
  const bank = page.getByRole("group", { name: "Stages of Kalman bank (MMAE)" });
  await expect(bank.getByText(/^\d+(\.\d+)?\s%$/).first()).toBeVisible();
  await expect(bank.getByText("m+10").first()).toBeVisible();
  await bank.getByRole("button", { name: "Weights" }).click();
  await expect(page.getByRole("region", { name: "Equations: Weights" })).toContainText("5.2.3.2.6");

  for (const screen of SCREENS) {
    await showOn(page, screen);
    if (screen.width < 600) await page.getByRole("combobox", { name: "Another panel" }).selectOption("schematic");
    await drawing.selectOption({ label: "Diagnosis: Kalman bank (MMAE)" });
    await expectClean(page, `the bank at ${screen.width}`);
    for (const scheme of SCHEMES) await expectReadable(page, `the bank at ${screen.width}`, scheme);
  }
});

test("a unit of one's own is drawn as one stage", async ({ page, openDocument }) => {
  const text = `"""Twice the reference."""
from core.block import Block, BlockParams
from core.control.controller import ControllerPorts
from core.record import Record


class Twice(Block):
    """Twice the reference."""

    title = "Twice"

    class Params(BlockParams):
        """None."""

    class Ports(ControllerPorts):
        """The ports of every controller."""

    @staticmethod
    def step(p: Record, s: Record, x: Ports) -> None:
        """Amplify."""
        x.voltage = 2.0 * x.reference
`;
  await openDocument({
    device: SEVEN,
    reference: SINE,
    controller: { kind: "twice" },
    units: { twice: { source: text } },
  });
  await page.getByRole("combobox", { name: "Drawing" }).selectOption({ label: "Controller: Twice" });
  const stages = page.getByRole("group", { name: "Stages of Twice" });
  await expect(stages.getByRole("button")).toHaveText(["Twice"]);
  await expect(stages.getByText("voltage", { exact: true })).toBeVisible();
});
