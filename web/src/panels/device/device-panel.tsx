import { Box } from "@mantine/core";
import { hasAxes } from "../../api/fits";
import { send } from "../../bench/send";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatSi } from "../../ui/format";
import { Knob } from "../../ui/knob";
import { AIR, AROUND_A_PACKAGE, ENVIRONMENT } from "../../ui/surroundings";
import { BlockValues, TitledValues } from "../card/block-values";
import styles from "./device.module.css";
import { Instrument } from "./instrument";
import { PlantChoice } from "./plant-choice";
import { SensorChoice } from "./sensor-choice";

const FRICTION = { label: "Friction dead band", unit: "nN", low: 0, high: 500, step: 1 };
/** Blocks of the board beside device and sensor. */
const BOARD_BLOCKS = ["sampler", "drive", "amplifier", "guard", "model"];

/** The model of the device and its values. */
export function DeviceView() {
  const title = useBench((s) => s.bench?.title);
  if (title === undefined)
    return <EmptyState title="No bench yet">The device of the bench and its model are chosen here.</EmptyState>;
  return (
    <section className={`view-page ${styles.panel}`} aria-label="Device">
      <Instrument />
      <h2>Model</h2>
      <PlantChoice />
      <BlockValues id="plant" />
    </section>
  );
}

/** The sensor that feeds the controllers and its values. */
export function SensorView() {
  const id = useBench((s) => s.bench?.id);
  if (!id) return <EmptyState title="No bench yet">The sensor of the bench is chosen here.</EmptyState>;
  return (
    <section className={`view-page ${styles.panel}`} aria-label="Sensor">
      <SensorChoice />
      <BlockValues id="sensor" />
    </section>
  );
}

/** Air and friction around the device. */
export function EnvironmentView() {
  const environment = useBench((s) => s.bench?.parameters.environment) as Record<string, number> | undefined;
  const faults = useBench((s) => s.bench?.faults);
  const id = useBench((s) => s.bench?.id);
  const isFlat = useBench((s) => !hasAxes(s.bench));
  if (!id) return <EmptyState title="No bench yet">Air and friction around the device are set here.</EmptyState>;

  const friction = faults?.find((f) => f.name === "stiction")?.severity ?? 0;
  const rub = (value: number) =>
    value > 0
      ? send({ fault: "stiction", severity: value, profile: { kind: "step" } }, "Friction set")
      : send({ heal: ["stiction"] }, "Friction gone");
  return (
    <section className={`view-page ${styles.panel}`} aria-label="Environment">
      <h2>{isFlat ? "Air" : "Around the package"}</h2>
      {(isFlat ? ENVIRONMENT : AROUND_A_PACKAGE).map((knob) => (
        <Knob
          key={knob.path}
          {...knob}
          value={environment?.[knob.path] ?? AIR[knob.path]}
          original={AIR[knob.path]}
          onChange={(value) => void send({ set: { [`environment.${knob.path}`]: value } }, `${knob.label} set`)}
        />
      ))}
      {isFlat && (
        <Knob
          {...FRICTION}
          value={friction}
          original={0}
          minimum={0}
          note="The shuttle sticks while the net force is smaller: the fault stiction, as a slider."
          onChange={(value) => void rub(value)}
        />
      )}
      {!isFlat && (
        <Box component="p" className="note" m="6px 0">
          The device is sealed: air outside does not reach it. The fault Leak of the package raises the pressure inside.
        </Box>
      )}
    </section>
  );
}

/** The rate of the board, and the values of its stages, its drive, its guard and its reference model. */
export function BoardView() {
  const rate = useBench((s) => s.bench?.sample_rate_khz);
  const dtMs = useBench((s) => s.bench?.dt_ms);
  if (!rate || !dtMs) return <EmptyState title="No bench yet">Rate, drive and guard of the board are here.</EmptyState>;
  return (
    <section className={`view-page ${styles.panel}`} aria-label="Board">
      <Box component="p" className="note" m="6px 0">
        {formatSi(rate, "kHz")}, one tick each {formatSi(dtMs, "ms")}.
      </Box>
      <TitledValues ids={BOARD_BLOCKS} />
    </section>
  );
}
