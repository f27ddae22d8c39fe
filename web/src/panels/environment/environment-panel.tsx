import { hasAxes } from "../../api/fits";
import { send } from "../../bench/send";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { Knob } from "../../ui/knob";
import { AIR, AROUND_A_PACKAGE, ENVIRONMENT } from "../../ui/surroundings";
import styles from "./environment.module.css";
import { PlantChoice } from "./plant-choice";
import { SensorChoice } from "./sensor-choice";

const FRICTION = { label: "Friction dead band", unit: "nN", low: 0, high: 500, step: 1 };

/** What is around the device and how it is modelled and seen: air, friction, sensor, plant. All of it live. */
export function EnvironmentPanel() {
  const environment = useBench((s) => s.bench?.parameters.environment) as Record<string, number> | undefined;
  const faults = useBench((s) => s.bench?.faults);
  const id = useBench((s) => s.bench?.id);
  const isFlat = useBench((s) => !hasAxes(s.bench));
  if (!id)
    return <EmptyState title="No bench yet">Air, friction, sensor and plant of the bench are set here.</EmptyState>;

  const friction = faults?.find((f) => f.name === "stiction")?.severity ?? 0;
  const rub = (value: number) =>
    value > 0
      ? send({ fault: "stiction", severity: value, profile: { kind: "step" } }, "Friction set")
      : send({ heal: ["stiction"] }, "Friction gone");
  return (
    <section className={styles.panel} aria-label="Environment">
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
        <p className={styles.note}>
          The device is sealed: air outside does not reach it. The fault Leak of the package raises the pressure inside.
        </p>
      )}
      <h2>Sensor</h2>
      <SensorChoice />
      <h2>Plant</h2>
      <PlantChoice />
    </section>
  );
}
