import { Box, NativeSelect } from "@mantine/core";
import type { Device, DeviceCatalogue } from "../api/types";
import { Knob } from "../ui/knob";
import { AIR, AROUND_A_PACKAGE, ENVIRONMENT, type Knob as KnobOf } from "../ui/surroundings";
import {
  catalogued,
  changed,
  type DesignState,
  isDrawnGyroscope,
  isGyroscope,
  newDesign,
  valueIn,
  withFringing,
} from "./design";
import styles from "./designer.module.css";
import { ElectrodeControls } from "./electrode-controls";
import { COMBS, TUNING } from "./electrodes";
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
  const write = (path: string, original: number) => (value: number) => onChange(changed(state, path, value, original));
  const turn = (knob: KnobOf, original: number, set = write(knob.path, original)) => {
    const card = cardOf(catalogue, knob.path);
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
  const fringing = hasCombOfItsSize(device) && (
    <NativeSelect
      label="Field beyond the fingers"
      value={String(state.changes.fringing ?? "")}
      data={[
        { value: "", label: "None: the force of plates" },
        ...catalogue.fringing.choices.map((value) => ({ value, label: FIELDS[value] ?? value })),
      ]}
      onChange={(event) => onChange(withFringing(state, event.currentTarget.value))}
    />
  );
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
          {group.knobs.map((knob) => turn(knob, base(knob.path) ?? Number(cardOf(catalogue, knob.path)?.default ?? 0)))}
          {group.knobs.some(({ path }) => path.endsWith("fingers")) && fringing}
        </fieldset>
      ))}
      {isGyroscope(device) && (
        <ElectrodeControls
          electrodes={isDrawnGyroscope(device) ? [TUNING] : [...COMBS, TUNING]}
          {...{ state, onChange, turn }}
        />
      )}
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

const FIELDS: Record<string, string> = {
  grounded_plane: "Over a grounded plane",
  free: "Without a plane",
};

/** Whether the force of a device follows from the sizes of its comb: fringing is contained in a given force. */
const hasCombOfItsSize = (device: Device) =>
  !isGyroscope(device) &&
  catalogued(device, "force_n_per_v") === undefined &&
  (catalogued(device, "geometry.fingers") ?? catalogued(device, "fingers")) !== undefined;

type Cards = DeviceCatalogue["geometry"];

/** The description of a number of a device, by its dotted path. */
function cardOf(catalogue: DeviceCatalogue, path: string): Cards[number] | undefined {
  const tables: [string, Cards][] = [
    ["geometry.", catalogue.geometry],
    ["electrodes.drive.", catalogue.comb],
    ["electrodes.sense.", catalogue.comb],
    ["electrodes.tuning.", catalogue.tuning],
  ];
  const [table, cards] = tables.find(([name]) => path.startsWith(name)) ?? ["", []];
  return cards.find(({ name }) => table + name === path);
}
