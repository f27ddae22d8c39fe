import { ActionIcon, Tooltip } from "@mantine/core";
import { IconArrowBackUp } from "@tabler/icons-react";
import { useState } from "react";
import { formatShort } from "./format";
import styles from "./knob.module.css";
import { NumberField } from "./number-field";
import { Slider } from "./slider";
import { roundTo, unitText } from "./unit-scale";

interface KnobProps {
  label: string;
  unit: string;
  /** Ends of the slider; exact entry may go beyond, to the limits. */
  low: number;
  high: number;
  step: number;
  log?: boolean;
  value: number;
  original: number;
  minimum?: number | null;
  maximum?: number | null;
  note?: string;
  /** While the slider moves, if that should show at once. */
  onMove?(value: number): void;
  onChange(value: number): void;
}

/** A slider in words with exact entry, its unit, a mark where it was, and the way back there. */
export function Knob(props: KnobProps) {
  const {
    label,
    unit,
    low,
    high,
    step,
    log = false,
    value,
    original,
    minimum,
    maximum,
    note,
    onMove,
    onChange,
  } = props;
  const [draft, setDraft] = useState<number | undefined>(undefined);
  const scale = { low, high, log };
  const shown = draft ?? value;
  const isOriginal = Math.abs(value - original) <= 1e-9 * Math.abs(original);
  const take = (position: number) => valueAt(position, scale, step);
  return (
    <div className={styles.knob} data-changed={!isOriginal}>
      <div className={`row ${styles.line}`}>
        <span className={styles.label}>{label}</span>
        {!isOriginal && (
          <Tooltip label={`Back to ${formatShort(original, unit)}`}>
            <ActionIcon
              size={20}
              aria-label={`${label}: back to ${formatShort(original, unit)}`}
              onClick={() => onChange(original)}
            >
              <IconArrowBackUp size={13} />
            </ActionIcon>
          </Tooltip>
        )}
        <NumberField
          label={label}
          unit={unitText(unit)}
          value={roundTo(shown, 6)}
          minimum={minimum ?? null}
          maximum={maximum ?? null}
          integer={step === 1 && unit === ""}
          onCommit={onChange}
        />
      </div>
      <Slider
        size="xs"
        min={0}
        max={1}
        step={0.001}
        label={null}
        thumbLabel={label}
        value={positionOf(shown, scale)}
        marks={[{ value: positionOf(original, scale) }]}
        onChange={(position) => {
          setDraft(take(position));
          onMove?.(take(position));
        }}
        onChangeEnd={(position) => {
          setDraft(undefined);
          onChange(take(position));
        }}
      />
      {note && <small className={styles.note}>{note}</small>}
    </div>
  );
}

interface SliderScale {
  low: number;
  high: number;
  log: boolean;
}

/** Place of a value on a slider from 0 to 1; beyond its ends it stays at them. */
export function positionOf(value: number, { low, high, log }: SliderScale): number {
  const share = log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  return Math.min(1, Math.max(0, Number.isFinite(share) ? share : 0));
}

/** Value at a place, on steps; on a logarithmic scale in three digits. */
export function valueAt(position: number, { low, high, log }: SliderScale, step: number): number {
  const value = log ? low * (high / low) ** position : low + (high - low) * position;
  return step > 0 ? roundTo(Math.round(value / step) * step, 8) : roundTo(value, 3);
}
