import { Box, NativeSelect } from "@mantine/core";
import type { Device, DeviceCatalogue } from "../api/types";
import { Knob } from "../ui/knob";
import { AIR, AROUND_A_PACKAGE, ENVIRONMENT, type Knob as KnobOf } from "../ui/surroundings";
import { catalogued, changed, type DesignState, isDrawnGyroscope, isGyroscope, newDesign, valueIn } from "./design";
import styles from "./designer.module.css";
import { DRAWN_GYROSCOPE, gyroscopeKnobs } from "./gyroscope-knobs";
import { DRAWING, given } from "./knobs";

interface DesignerControlsProps {
  catalogue: DeviceCatalogue;
  device: Device;
  state: DesignState;
  onChange(state: DesignState): void;
}

/** Everything that can be turned about a device and the air around it. */
export function DesignerControls({ catalogue, device, state, onChange }: DesignerControlsProps) {
  const base = (path: string) => catalogued(device, path);
  const groups = () => {
    if (isDrawnGyroscope(device)) return DRAWN_GYROSCOPE;
    if (isGyroscope(device)) return gyroscopeKnobs(base);
    return base("geometry.beam_length_um") === undefined ? given(base) : DRAWING;
  };
  const turn = (knob: KnobOf, original: number) => {
    const set = (value: number) => onChange(changed(state, knob.path, value, original));
    const card = catalogue.geometry.find((p) => `geometry.${p.name}` === knob.path);
    return (
      <Knob
        key={knob.path}
        {...knob}
        value={valueIn(state, knob.path, original)}
        original={original}
        minimum={card?.minimum}
        maximum={card?.maximum}
        {...both(set)}
      />
    );
  };
  return (
    <section className={`card ${styles.controls}`} aria-label="Knobs">
      <NativeSelect
        label="Device"
        value={state.id}
        data={catalogue.devices.map((d) => ({ value: d.id, label: d.title || d.id }))}
        onChange={(event) => onChange({ ...newDesign(event.currentTarget.value), environment: state.environment })}
      />
      <Box component="p" className="note" mt={8}>
        {device.source}
      </Box>
      {groups().map((group) => (
        <fieldset key={group.title} className={styles.group}>
          <legend>{group.title}</legend>
          {group.knobs.map((knob) => turn(knob, base(knob.path) ?? defaultOf(catalogue, knob.path)))}
        </fieldset>
      ))}
      <fieldset className={styles.group}>
        <legend>Environment</legend>
        {(isGyroscope(device) ? AROUND_A_PACKAGE : ENVIRONMENT).map((knob) => {
          const { environment } = state;
          const set = (value: number) => onChange({ ...state, environment: { ...environment, [knob.path]: value } });
          const air = AIR[knob.path];
          return <Knob key={knob.path} {...knob} {...both(set)} value={environment[knob.path] ?? air} original={air} />;
        })}
      </fieldset>
    </section>
  );
}

const both = (set: (value: number) => void) => ({ onMove: set, onChange: set });

function defaultOf(catalogue: DeviceCatalogue, path: string): number {
  return Number(catalogue.geometry.find((p) => `geometry.${p.name}` === path)?.default ?? 0);
}
