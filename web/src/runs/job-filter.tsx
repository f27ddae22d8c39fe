import { NativeSelect, TextInput } from "@mantine/core";
import type { RunFilter } from "../api/types";
import styles from "./runs.module.css";

const STATES = ["queued", "running", "done", "failed", "cancelled", "aborted"] as const;

interface JobFilterProps {
  filter: RunFilter;
  /** Scenarios to choose from. */
  scenarios: readonly string[];
  onChange(filter: RunFilter): void;
}

/** Which runs and campaigns the list has: words in their names, a state, a scenario. */
export function JobFilter({ filter, scenarios, onChange }: JobFilterProps) {
  return (
    <search className={styles.filter}>
      <TextInput
        type="search"
        aria-label="Search runs"
        placeholder="Name, title or scenario"
        value={filter.text ?? ""}
        onChange={(e) => onChange({ ...filter, text: e.currentTarget.value })}
      />
      <NativeSelect
        aria-label="State"
        value={filter.state ?? ""}
        data={[{ value: "", label: "Any state" }, ...STATES.map((state) => ({ value: state as string, label: state }))]}
        onChange={(e) => onChange({ ...filter, state: STATES.find((state) => state === e.currentTarget.value) })}
      />
      <NativeSelect
        aria-label="Scenario of the runs"
        value={filter.scenario ?? ""}
        data={[{ value: "", label: "Any scenario" }, ...scenarios]}
        onChange={(e) => onChange({ ...filter, scenario: e.currentTarget.value })}
      />
    </search>
  );
}
