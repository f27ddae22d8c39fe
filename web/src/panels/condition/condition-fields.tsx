import { NativeSelect, NumberInput } from "@mantine/core";
import { useMemo } from "react";
import { useBench } from "../../stream/bench-store";
import { unitText } from "../../ui/unit-scale";
import { type Condition, signalGroups } from "./condition";

interface ConditionFieldsProps {
  label: string;
  /** The words for no signal, where a condition is optional. */
  none?: string;
  condition: Condition;
  /** A mistake in the level. */
  error?: string;
  onChange(condition: Condition): void;
}

/** A signal of the bench, above or below, and a level in the unit of the signal. */
export function ConditionFields({ label, none, condition, error, onChange }: ConditionFieldsProps) {
  const signals = useBench((s) => s.bench?.signals);
  const groups = useMemo(() => signalGroups(signals ?? []), [signals]);
  const chosen = signals?.find((s) => s.name === condition.signal);
  const unit = unitText(chosen?.unit ?? "");
  const set = (part: Partial<Condition>) => onChange({ ...condition, ...part });
  return (
    <>
      <NativeSelect
        label={label}
        title={chosen?.meaning}
        value={condition.signal}
        data={none === undefined ? groups : [{ value: "", label: none }, ...groups]}
        onChange={(e) => set({ signal: e.currentTarget.value })}
      />
      {condition.signal && (
        <>
          <NativeSelect
            label="is"
            value={condition.above ? ">" : "<"}
            data={[
              { value: ">", label: "above" },
              { value: "<", label: "below" },
            ]}
            onChange={(e) => set({ above: e.currentTarget.value === ">" })}
          />
          <NumberInput
            miw={92}
            label="Level"
            suffix={unit && ` ${unit}`}
            step={0.1}
            value={condition.level}
            error={error}
            onChange={(level) => set({ level })}
          />
        </>
      )}
    </>
  );
}
