import { Switch } from "@mantine/core";
import type { ReactNode } from "react";
import type { Knob } from "../ui/surroundings";
import { type DesignState, tableIn, withTable } from "./design";
import styles from "./designer.module.css";
import type { Electrode } from "./electrodes";

interface ElectrodeControlsProps {
  electrodes: Electrode[];
  state: DesignState;
  onChange(state: DesignState): void;
  /** A knob with the value that it begins with. */
  turn(knob: Knob, original: number, set: (value: number) => void): ReactNode;
}

/** A switch for each electrode that a gyroscope may have, and its knobs while the switch is on. */
export function ElectrodeControls({ electrodes, state, onChange, turn }: ElectrodeControlsProps) {
  return electrodes.map(({ table, title, knobs, first }) => {
    const values = tableIn(state, table);
    return (
      <fieldset key={table} className={styles.group} aria-label={title}>
        <Switch
          size="xs"
          label={title}
          checked={values !== undefined}
          onChange={(event) => onChange(withTable(state, table, event.currentTarget.checked ? first : undefined))}
        />
        {values &&
          knobs.map((knob) => {
            const name = knob.path.slice(table.length + 1);
            return turn(knob, first[name], (value) => onChange(withTable(state, table, { ...values, [name]: value })));
          })}
      </fieldset>
    );
  });
}
