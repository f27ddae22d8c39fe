import { Button, Group, NativeSelect, NumberInput, Text } from "@mantine/core";
import { IconArrowLeft } from "@tabler/icons-react";
import { useEffect, useState } from "react";
import { api } from "../api/api";
import { useMay } from "../api/me";
import { useAnswer } from "../api/queries";
import type { DiagnosedRecord, RecordCalibration, RecordDetail } from "../api/types";
import { openOwn } from "../bench/open-bench";
import { useBusy } from "../bench/use-busy";
import { setPage, useView } from "../bench/view-store";
import { byChapter } from "../gallery/chapters";
import { Stale } from "../ui/stale";
import { CalibrationView } from "./calibration-view";
import { DiagnosisView } from "./diagnosis-view";
import { useRecords } from "./open-record";
import { brief } from "./record-list";
import { RecordPlot } from "./record-plot";
import styles from "./records.module.css";
import { SaveDevice } from "./save-device";

const POINTS = 700;
const USUAL = "first-look";

/** A record: its plot, the healthy stretch on it, the calibration by this stretch, and the ways on from there. */
export function RecordView({ id }: { id: string }) {
  const [range, setRange] = useState<[number, number] | undefined>(undefined);
  const { value, error, since, again } = useAnswer(["device-record", id, ...(range ?? [])], () =>
    api.deviceRecord(id, { points: POINTS, ...(range ? { start: range[0], end: range[1] } : {}) }),
  );
  const [record, setRecord] = useState<RecordDetail | undefined>(undefined);
  useEffect(() => {
    if (value) setRecord(value);
  }, [value]);
  return (
    <>
      <Button
        size="compact-sm"
        variant="subtle"
        leftSection={<IconArrowLeft size={14} />}
        onClick={() => useRecords.setState({ shown: undefined, file: undefined })}
      >
        All records
      </Button>
      <Stale error={error} since={since} onRetry={again} />
      {record && <Shown record={record} range={range ?? [0, record.samples]} onRange={setRange} />}
    </>
  );
}

interface ShownProps {
  record: RecordDetail;
  range: [number, number];
  onRange(range: [number, number] | undefined): void;
}

function Shown({ record, range, onRange }: ShownProps) {
  const [healthy, setHealthy] = useState<[number, number]>([0, Math.max(2, Math.floor(record.samples / 4))]);
  const [scenario, setScenario] = useState(USUAL);
  const [scenarios, setScenarios] = useState<string[]>([USUAL]);
  const [calibration, setCalibration] = useState<RecordCalibration | undefined>(undefined);
  const [diagnosis, setDiagnosis] = useState<DiagnosedRecord | undefined>(undefined);
  const [busy, during] = useBusy<string>();
  useEffect(() => {
    api.scenarios().then(
      (all) =>
        setScenarios(
          all
            .filter(({ plant }) => plant !== null && plant !== "gyroscope")
            .sort(byChapter)
            .map((one) => one.id),
        ),
      () => undefined, // the usual bench needs no list
    );
  }, []);
  const choose = (next: [number, number]) => {
    setHealthy(next);
    setCalibration(undefined);
    setDiagnosis(undefined);
  };
  const stretch = { scenario, first: healthy[0], end: healthy[1] };
  const calibrate = () =>
    during(async () => {
      setDiagnosis(undefined);
      setCalibration(await api.calibrateRecord(record.id, stretch));
    }, "calibrate");
  const diagnose = () =>
    during(async () => {
      const found = await api.diagnoseRecord(record.id, stretch);
      setCalibration(found.calibration);
      setDiagnosis(found);
    }, "diagnose");
  const open = () =>
    during(async () => {
      const bench = await api.createBench({
        scenario,
        record: record.id,
        set: calibration?.values ?? {},
        paused: false,
      });
      openOwn(bench.id);
      setPage("bench");
      useView.setState({ dialog: "none" });
    }, "open");
  const teaches = useMay("teach");
  const fits = calibration !== undefined && !calibration.refusal;
  return (
    <section aria-label={record.name}>
      <h3 className={styles.name}>{record.name}</h3>
      <p className="note">{brief(record)}</p>
      {record.notes.map((note) => (
        <p key={note} className="note">
          Note: {note}.
        </p>
      ))}
      <RecordPlot record={record} range={range} healthy={healthy} onHealthy={choose} />
      <Group gap={8} align="end">
        <NumberInput
          label="Healthy from sample"
          w={140}
          min={0}
          max={healthy[1] - 1}
          value={healthy[0]}
          onChange={(from) => typeof from === "number" && choose([from, healthy[1]])}
        />
        <NumberInput
          label="to before sample"
          w={140}
          min={healthy[0] + 1}
          max={record.samples}
          value={healthy[1]}
          onChange={(to) => typeof to === "number" && choose([healthy[0], to])}
        />
        <Button onClick={() => onRange(healthy)}>Zoom in</Button>
        <Button disabled={range[0] === 0 && range[1] === record.samples} onClick={() => onRange(undefined)}>
          Whole record
        </Button>
      </Group>
      <Text size="xs" c="dimmed" my={4}>
        Drag over the plot to choose the stretch in which the device was healthy.
      </Text>
      <NativeSelect
        label="Bench whose device is the nominal one"
        value={scenario}
        data={scenarios}
        onChange={(e) => {
          setScenario(e.currentTarget.value);
          setCalibration(undefined);
          setDiagnosis(undefined);
        }}
      />
      <Group gap={8} my={12}>
        <Button variant={calibration ? "default" : "filled"} loading={busy === "calibrate"} onClick={calibrate}>
          Calibrate
        </Button>
        <Button
          variant={fits && !diagnosis ? "filled" : "default"}
          loading={busy === "diagnose"}
          disabled={calibration !== undefined && !fits}
          onClick={diagnose}
        >
          Diagnose
        </Button>
        <Button loading={busy === "open"} onClick={open}>
          {fits ? "Open on a bench" : "Open on a bench, not calibrated"}
        </Button>
      </Group>
      {!teaches && <p className="note">On a bench it takes the place of yours.</p>}
      {busy && <p role="status">{busy === "open" ? "Making the bench…" : "Computing; seconds on a long record…"}</p>}
      {calibration && <CalibrationView calibration={calibration} />}
      {fits && <SaveDevice record={record.id} stretch={stretch} />}
      {diagnosis && fits && <DiagnosisView diagnosis={diagnosis} record={record} />}
    </section>
  );
}
