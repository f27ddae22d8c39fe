import { screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import type { DiagnosedRecord, RecordCalibration, RecordDetail } from "../api/types";
import { useView } from "../bench/view-store";
import { Refusal, server } from "../testing/fake-server";
import { recordedAnswer } from "../testing/recorded";
import { penOf } from "../testing/recording-pen";
import { be, mount, words } from "../testing/render";
import { openRecordFile, useRecords } from "./open-record";
import { RecordSheet } from "./record-sheet";

const scenarios = await recordedAnswer("scenarios");
const N = 40;
const wave = (part: number) => Array.from({ length: N }, (_, i) => part * Math.sin(i));
const record: RecordDetail = {
  id: "r1",
  key: "ab".repeat(32),
  name: "mine.csv",
  rate_khz: 50,
  samples: 4000,
  bytes: 64_000,
  columns: { drive: "u", displacement: "y" },
  notes: ["3 samples are lost"],
  labels: [],
  lost: 3,
  drive_v: [-5, 5],
  displacement_um: [-1, 1],
  created: "2026-01-01T00:00:00Z",
  plot: {
    sample: Array.from({ length: N }, (_, i) => 100 * i),
    drive_low: wave(-5),
    drive_high: wave(5),
    displacement_low: wave(-1).map((value, i) => (i === 7 ? null : value)),
    displacement_high: wave(1).map((value, i) => (i === 7 ? null : value)),
  },
};
const about = (value: number) => ({ value, error: 0.001, low: value - 0.00196, high: value + 0.00196 });
const calibration: RecordCalibration = {
  mass: about(1.03),
  damping: about(1.12),
  stiffness: about(0.98),
  offset_um: about(0.3),
  delay_samples: about(1.5),
  noise_um: 0.012,
  quantum_um: 0.002,
  samples: 1000,
  checks: [
    { name: "residual_ratio", value: 1.02, limit: 1.3, ok: true, sentence: "" },
    { name: "correlation", value: 0.05, limit: 0.2, ok: true, sentence: "" },
  ],
  refusal: "",
  values: { "device.mass_kg": 2.3e-10 },
};
const diagnosis: DiagnosedRecord = {
  calibration,
  refusal: "",
  banks: [
    {
      name: "kalman",
      healthy: "healthy",
      shares: { healthy: 0.5, "m+5": 0.25, unexplained: 0.25 },
      verdicts: [
        { first: 0, end: 2000, verdict: "healthy", probability: 0.99 },
        { first: 2000, end: 3000, verdict: "m+5", probability: 0.97 },
        { first: 3000, end: 4000, verdict: "unexplained", probability: 0.9 },
      ],
      left_out: 0,
    },
  ],
  figures: {},
};
const csv = (name = "mine.csv") => new File(["a,b\n1,2\n3,4\n"], name);

beforeEach(() => {
  useRecords.setState({ file: undefined, shown: undefined });
  useView.setState({ dialog: "record" });
  server.on("GET", "/records", { records: [] });
  server.on("GET", "/scenarios", scenarios);
  server.on("GET", "/records/:id", record);
});

/** The sheet with the record. */
async function shown() {
  useRecords.setState({ shown: "r1" });
  const { user } = mount(<RecordSheet />);
  await screen.findByRole("region", { name: "mine.csv" });
  return user;
}

it("asks for the columns and the rate only where they were not found, and reads the file with them", async () => {
  let asked = 0;
  server.on("POST", "/records", () => {
    asked += 1;
    return asked > 1 ? record : new Refusal(422, "record: has no column for the drive; its columns are a, b");
  });
  const number = { unit: "", is_number: true };
  server.on("POST", "/records/columns", {
    columns: [
      { name: "a", ...number, unit: "mv" },
      { name: "y", ...number },
      { name: "note", unit: "", is_number: false },
    ],
    found: { displacement: "y" },
  });
  const { user } = mount(<RecordSheet />);
  openRecordFile(csv());
  expect(await screen.findByRole("alert")).toHaveTextContent("mine.csv: record: has no column for the drive");
  const form = within(await screen.findByRole("form", { name: "Columns of the file" }));
  expect(form.queryByLabelText("Column of the displacement")).not.toBeInTheDocument();
  const drive = form.getByLabelText("Column of the drive voltage");
  expect(
    within(drive)
      .getAllByRole("option")
      .map((one) => one.textContent),
  ).toEqual(["choose", "a, in mv", "y"]);
  const read = form.getByRole("button", { name: "Read the record" });
  expect(read).toBeDisabled();
  await user.selectOptions(drive, "a");
  await user.type(form.getByLabelText("Samples for each ms"), "50");
  await user.click(read);
  expect(await screen.findByRole("region", { name: "mine.csv" })).toBeVisible();
  expect(server.asked("POST", "/records").map(({ query }) => query)).toEqual([
    { name: "mine.csv", pairing: "next" },
    { name: "mine.csv", pairing: "next", drive: "a", rate_khz: "50" },
  ]);
});

it("shows a refusal in its words where no column is missing", async () => {
  server.on("POST", "/records", new Refusal(422, "record: row 3, column u: 'x' is no number"));
  server.on("POST", "/records/columns", { columns: [], found: { drive: "u", displacement: "y", time: "t" } });
  mount(<RecordSheet />);
  openRecordFile(csv());
  expect(await screen.findByRole("alert")).toHaveTextContent("row 3, column u: 'x' is no number");
  await waitFor(() => expect(server.asked("POST", "/records/columns")).toHaveLength(1));
  expect(screen.queryByRole("form")).not.toBeInTheDocument();
});

it("plots voltage and displacement with a gap where samples are lost, and a drag chooses the healthy stretch", async () => {
  const user = await shown();
  const plot = screen.getByRole("img", { name: /^mine\.csv: voltage and displacement/ });
  expect(penOf(plot).words).toEqual(expect.arrayContaining(["voltage, V", "displacement, µm"]));
  expect(screen.getByText("Note: 3 samples are lost.")).toBeVisible();
  const stage = screen.getByTestId("record-plot");
  const at = (x: number) => ({ target: stage, coords: { clientX: x, clientY: 40 } });
  await user.pointer([{ ...at(260), keys: "[MouseLeft>]" }, at(120), { ...at(120), keys: "[/MouseLeft]" }]);
  const field = (name: string) => Number((screen.getByLabelText(name) as HTMLInputElement).value);
  const [first, end] = [field("Healthy from sample"), field("to before sample")];
  expect(first).toBeGreaterThan(0);
  expect(end).toBeGreaterThan(first);
  expect(end).toBeLessThan(4000);
  await user.pointer([{ ...at(200), keys: "[MouseLeft>]" }, at(201), { ...at(201), keys: "[/MouseLeft]" }]);
  expect([field("Healthy from sample"), field("to before sample")]).toEqual([first, end]);
});

it("calibrates by the stretch, shows ratios with intervals and the test, and opens a bench with the device", async () => {
  server.on("POST", "/records/:id/calibration", calibration);
  server.on("POST", "/benches", new Refusal(409, "the server is full"));
  const user = await shown();
  await user.click(screen.getByRole("button", { name: "Calibrate" }));
  const fitted = await screen.findByRole("table", { name: "Fitted device" });
  expect(within(fitted).getByRole("row", { name: /^Mass over nominal/ })).toHaveTextContent("1.03001.0280 to 1.0320");
  const tested = screen.getByRole("table", { name: "Test of the fit" });
  expect(within(tested).getByRole("row", { name: /^Error on the half/ })).toHaveTextContent("1.020 1.300");
  expect(
    screen.getByText(words("The fit holds: half of 1000 samples were fitted, the other half tests it.")),
  ).toBeVisible();
  expect(server.asked("POST", "/records/r1/calibration")[0].body).toEqual({
    scenario: "first-look",
    first: 0,
    end: 1000,
  });
  await user.click(screen.getByRole("button", { name: "Open on a bench" }));
  await waitFor(() => expect(server.asked("POST", "/benches")).toHaveLength(1));
  expect(server.asked("POST", "/benches")[0].body).toEqual({
    scenario: "first-look",
    record: "r1",
    set: calibration.values,
    paused: false,
  });
});

it("says why a record does not fit, and offers no diagnosis then", async () => {
  const refusal = "friction explains 83 % of the motion that mass, damper and spring leave unexplained";
  server.on("POST", "/records/:id/calibration", { ...calibration, refusal, values: {} });
  const user = await shown();
  await user.click(screen.getByRole("button", { name: "Calibrate" }));
  expect(await screen.findByRole("alert")).toHaveTextContent(`Refused: ${refusal}.`);
  expect(screen.getByRole("button", { name: "Diagnose" })).toBeDisabled();
  expect(screen.getByRole("button", { name: "Open on a bench, not calibrated" })).toBeEnabled();
  expect(screen.queryByLabelText("Keep this device as")).not.toBeInTheDocument();
});

it("shows the verdicts over time, and that there is no score without labels", async () => {
  server.on("POST", "/records/:id/diagnosis", diagnosis);
  const user = await shown();
  await user.click(screen.getByRole("button", { name: "Diagnose" }));
  const rows = within(await screen.findByRole("list", { name: "Verdicts of kalman" })).getAllByRole("listitem");
  expect(rows.map((row) => row.textContent?.replace(/\s/g, " "))).toEqual([
    "0.000 ms to 40.000 mshealthyprobability 0.990",
    "40.000 ms to 60.000 msm+5probability 0.970",
    "60.000 ms to 80.000 msunexplainedno hypothesis explains this",
  ]);
  expect(screen.getByText(/^The record has no labels/)).toBeVisible();
});

it("keeps the device under a name, for who teaches alone", async () => {
  server.on("POST", "/records/:id/calibration", calibration);
  server.on("POST", "/measured-devices", {
    id: "d",
    name: "wafer 7",
    record_key: record.key,
    values: {},
    created: record.created,
  });
  const user = await shown();
  await user.click(screen.getByRole("button", { name: "Calibrate" }));
  await user.type(await screen.findByLabelText("Keep this device as"), "wafer 7");
  await user.click(screen.getByRole("button", { name: "Keep" }));
  expect(await screen.findByText(/^Kept as wafer 7/)).toBeVisible();
  expect(server.asked("POST", "/measured-devices")[0].body).toEqual({
    scenario: "first-look",
    first: 0,
    end: 1000,
    record: "r1",
    name: "wafer 7",
  });
  be("student");
  await waitFor(() => expect(screen.queryByText(/^Kept as/)).not.toBeInTheDocument());
});

it("lists the records that are here, and opens one", async () => {
  server.on("GET", "/records", { records: [record] });
  const { user } = mount(<RecordSheet />);
  expect(await screen.findByText(/4000 samples at 50 kHz · no labels$/)).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Open mine.csv" }));
  expect(await screen.findByRole("region", { name: "mine.csv" })).toBeVisible();
});
