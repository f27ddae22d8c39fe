import { expect, front, HYPOTHESES, inWords, test } from "./lab";

const FAULTS = ["m+5", "m+10", "k+5", "k+10", "b+30"];

/** A loop that goes over to another law while its bank names a fault, and an extended Kalman filter beside the bank. */
const SUPERVISED = {
  schema: 1,
  id: "supervised",
  title: "A supervised loop",
  sample_rate_khz: 50,
  samples: 1_000_000,
  device: { id: "ch3", force_n_per_v: 6.375e-9, bias_v: 6 },
  plant: { model: "linear", drive: "held", drive_noise_v: 0.01, thermal_noise: false },
  reference: { kind: "sine", amplitude_v: 10, frequency_hz: 2000 },
  controller: { kind: "lqg" },
  sensor: { kind: "ideal", noise_um: 0.05 },
  diagnosers: { kalman: { kind: "mmae", hypotheses: HYPOTHESES }, ekf: { kind: "ekf" } },
  supervisor: {
    kind: "switching",
    diagnoser: "kalman",
    nominal: "lqg",
    controllers: Object.fromEntries(FAULTS.map((name) => [name, "adrc"])),
  },
};

test("a supervisor changes the controller for a fault and back, and says its verdict, its act and the reason", async ({
  page,
  server,
  openDocument,
}) => {
  const bench = await openDocument(SUPERVISED);
  const controller = page.getByRole("combobox", { name: "Controller" }).first();
  await server.advanceTicks(bench, 500);
  await expect(controller).toHaveValue("LQG");
  await expect(page.getByText("The supervisor changes the controller by the verdict of the diagnosis")).toBeAttached();
  await front(page, "Controller");
  const supervisor = page.getByRole("group", { name: "Supervisor" });
  await expect(supervisor).toContainText(/kalman has named healthy for [\d.]+\sms/);
  await expect(supervisor.getByRole("status")).toHaveText("It has not acted.");

  await front(page, "Faults");
  await page.getByRole("button", { name: /^Inject .*Added mass/ }).click();
  await expect(page.getByText(/^1\sactive fault$/)).toBeVisible();
  await server.advanceTicks(bench, 1000);
  await front(page, "Controller");
  const named = new RegExp(`kalman has named ${inWords("m+5").replace("+", "\\+")} for`);
  await expect(supervisor).toContainText(named);
  const act = "switches to Active disturbance rejection (ADRC), because kalman has named";
  await expect(supervisor.getByRole("status")).toContainText(`it ${act} ${inWords("m+5")}`);
  await expect(controller).toHaveValue(/ADRC/);
  await expect(page.getByText(`the supervisor ${act}`).first()).toBeVisible();
  await front(page, "Log", "Events");
  const entry = page.getByRole("button", { name: /^\d.* switch to adrc: kalman has named m\+5 for .*supervisor$/ });
  await expect(entry).toBeVisible();

  await page.keyboard.press("h");
  await server.advanceTicks(bench, 1500);
  await expect(controller).toHaveValue("LQG");
  await expect(page.getByRole("button", { name: /^\d.* switch to lqg: kalman has named healthy for/ })).toBeVisible();
  await front(page, "Diagnosis", "Scoreboard");
  await expect(page.getByRole("row", { name: /^Extended Kalman filter \(EKF\)/ }).first()).toContainText(/\d\s%/);
});
