import { Box, Button, type ButtonProps, Group } from "@mantine/core";
import { IconPlayerPauseFilled, IconPlayerPlayFilled } from "@tabler/icons-react";
import { useState } from "react";
import { classes } from "../api/classes";
import type { Command, Outcomes } from "../api/types";
import { useBusy } from "../bench/use-busy";
import { formatCount } from "../ui/format";
import styles from "./class.module.css";
import { FaultForAll } from "./fault-for-all";
import { CHOICE, GroupForAll } from "./group-for-all";
import { HideForAll } from "./hide-for-all";
import { outcomeLine } from "./members";
import { ScenarioSelect, useLibrary } from "./scenario-select";
import { SheetForAll } from "./sheet-for-all";

interface ForAllProps {
  group: string;
  /** How many students there are. */
  count: number;
  /** Ids of the chosen students; an empty list means all. */
  chosen: readonly string[];
  /** Ids of the students whose bench has tripped. */
  tripped: readonly string[];
  onChooseNone(): void;
  onDone(): void;
}

/** The commands for all benches at once, or for the benches of the chosen students; the outcome is in a line below. */
export function ForAll({ group, count, chosen, tripped, onChooseNone, onDone }: ForAllProps) {
  const library = useLibrary();
  const [scenario, setScenario] = useState("first-look");
  const [busy, during] = useBusy<string>();
  const [said, setSaid] = useState("");

  const some = chosen.length > 0 ? [...chosen] : null;
  const carryOut = (what: string, asked: () => Promise<Outcomes>) =>
    during(async () => {
      setSaid(outcomeLine(what, await asked()));
      onDone();
    }, what);
  const command = (what: string, order: Command) => carryOut(what, () => classes.command(group, order, some));
  const stopped = chosen.length > 0 ? tripped.filter((id) => chosen.includes(id)) : [...tripped];
  const begin = () => {
    const title = library.find(({ id }) => id === scenario)?.title ?? scenario;
    if (window.confirm(`Begin ${title} on all ${count} benches? Their present state is lost.`))
      void carryOut(title, () => classes.begin(group, { scenario, paused: false, quiet_lead: true }));
  };

  const startTogether = (what: string) =>
    window.confirm(
      "Start all together? Every bench that is not at tick 0 is reset first: its present state is lost.",
    ) && carryOut(what, () => classes.startTogether(group, some));
  const button = (what: string, act: (what: string) => unknown, look: ButtonProps & { title?: string }) => (
    <Button size="xs" loading={busy === what} disabled={count === 0} onClick={() => act(what)} {...look}>
      {what}
    </Button>
  );

  return (
    <Box component="section" className="card" p="8px 12px" aria-label="For all benches">
      <Group gap={8}>
        <Box component="b" miw="12ch" fw={600}>
          {chosen.length > 0 ? `For the ${chosen.length} chosen` : "For all benches"}
        </Box>
        {chosen.length > 0 && (
          <Button size="xs" variant="subtle" onClick={onChooseNone}>
            Choose none
          </Button>
        )}
        {button("Freeze", (what) => command(what, { kind: "pause" }), {
          leftSection: <IconPlayerPauseFilled size={15} />,
        })}
        {button("Release", (what) => command(what, { kind: "start" }), {
          leftSection: <IconPlayerPlayFilled size={15} />,
        })}
        {button("Start all together", startTogether, {
          title: "Every bench returns to tick 0, then all start at once. A bench at tick 0 keeps its settings.",
        })}
        {stopped.length > 0 && (
          <Button
            variant="filled"
            size="xs"
            color="alarm"
            loading={busy === "Reset trips"}
            title="Tripped benches are reset and stay frozen; Release lets them run."
            onClick={() => carryOut("Reset trips", () => classes.command(group, { reset_trip: true }, stopped))}
          >
            Reset {formatCount(stopped.length, "trip")}
          </Button>
        )}
      </Group>
      <div className={styles.groups}>
        <FaultForAll count={count} busy={busy} command={command} />
        <GroupForAll name="Scenario" label="A scenario for all">
          <ScenarioSelect {...CHOICE} aria-label="Scenario" value={scenario} onChange={setScenario} />
          <Button
            size="xs"
            disabled={count === 0 || chosen.length > 0}
            title={chosen.length > 0 ? "A scenario begins on all benches; choose none first" : undefined}
            onClick={begin}
          >
            Begin on all
          </Button>
        </GroupForAll>
        <HideForAll
          group={group}
          count={count}
          chosen={chosen}
          carryOut={(what, asked) => void carryOut(what, asked)}
        />
        <SheetForAll
          group={group}
          count={count}
          chosen={chosen}
          busy={busy !== undefined}
          onBegin={(title, asked) => void carryOut(title, asked)}
        />
      </div>
      <Box component="output" display="block" fz="sm" pt={said ? 6 : 0}>
        {said}
      </Box>
    </Box>
  );
}
