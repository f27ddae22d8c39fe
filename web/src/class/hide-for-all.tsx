import { Button, Checkbox, NativeSelect } from "@mantine/core";
import { useState } from "react";
import { blind } from "../api/blind";
import type { Outcomes } from "../api/types";
import { CHOICE, GroupForAll } from "./group-for-all";
import { useLibrary } from "./scenario-select";

const USUAL = "ch5-seven-step";

interface HideForAllProps {
  group: string;
  count: number;
  /** Ids of the chosen students; an empty list means all. */
  chosen: readonly string[];
  carryOut(what: string, asked: () => Promise<Outcomes>): void;
}

/** A hidden fault for each student, on a device of their own; and the answers for all. */
export function HideForAll({ group, count, chosen, carryOut }: HideForAllProps) {
  const library = useLibrary().filter(({ can_hide }) => can_hide);
  const [scenario, setScenario] = useState(USUAL);
  const [shows, setShows] = useState(false);
  const hide = () => {
    const whom = chosen.length > 0 ? `the ${chosen.length} chosen` : `all ${count}`;
    if (window.confirm(`Give ${whom} a new bench with a hidden fault? What is on their benches now is gone.`))
      carryOut("Set hidden faults", () =>
        blind.hideForAll(group, scenario, shows, chosen.length > 0 ? [...chosen] : null),
      );
  };
  return (
    <GroupForAll name="Hidden fault" label="Hidden faults for all">
      <NativeSelect
        {...CHOICE}
        aria-label="Bench of the hidden fault"
        value={scenario}
        data={library.map(({ id, title }) => ({ value: id, label: title }))}
        onChange={(e) => setScenario(e.currentTarget.value)}
      />
      <Checkbox
        label="Show the bank"
        title="Students see the verdicts of the diagnosers, but not the real fault"
        checked={shows}
        onChange={(e) => setShows(e.currentTarget.checked)}
      />
      <Button size="xs" disabled={count === 0} onClick={hide}>
        Set hidden faults
      </Button>
      <Button size="xs" disabled={count === 0} onClick={() => carryOut("Reveal answers", () => blind.revealAll(group))}>
        Reveal answers
      </Button>
    </GroupForAll>
  );
}
