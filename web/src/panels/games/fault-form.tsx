import { Box, Button, NativeSelect, Stack } from "@mantine/core";
import type { GameKind } from "../../api/types";
import { setValue, useGame } from "../../bench/game";
import { send } from "../../bench/send";
import { useBench } from "../../stream/bench-store";
import exercise from "../../ui/exercise.module.css";
import { formatShort } from "../../ui/format";
import { NumberField } from "../../ui/number-field";
import { unitText } from "../../ui/unit-scale";

/** The severity before a choice, the default of the server. */
const FIRST = 0.01;

/** A fault and its severity, to be tried on the bench and then named. */
export function FaultForm({ kinds, on }: { kinds: readonly GameKind[]; on: boolean }) {
  const values = useGame((s) => s.values);
  const acts = useBench((s) => (s.bench?.faults.length ?? 0) > 0);
  const kind = kinds.find(({ name }) => name === values.fault) ?? kinds[0];
  const { factor, unit } = shownIn(kind);
  const severity = typeof values.severity === "number" ? values.severity : FIRST;
  const limit = (end: number) => formatShort(end * factor, unit);
  return (
    <Stack gap={8} maw="70ch">
      <div className={`row ${exercise.bar}`}>
        <NativeSelect
          aria-label="Fault"
          value={kind.name}
          data={kinds.map(({ name, title }) => ({ value: name, label: title }))}
          onChange={(e) => useGame.setState({ values: { fault: e.currentTarget.value, severity } })}
        />
        <span className={exercise.field}>
          severity
          <NumberField
            label="Severity"
            unit={unitText(unit)}
            value={severity * factor}
            minimum={kind.minimum * factor}
            maximum={kind.maximum * factor}
            onCommit={(value) => setValue("severity", value / factor)}
          />
        </span>
        <Box component="small" maw="40ch">
          {limit(kind.minimum)} to {limit(kind.maximum)}
        </Box>
      </div>
      {on && (
        <div className={`row ${exercise.bar}`}>
          <Button size="xs" onClick={() => void send({ fault: kind.name, severity }, `Injected ${kind.title}`)}>
            Try it on the bench
          </Button>
          <Button size="xs" disabled={!acts} onClick={() => void send({ heal: "all" }, "Healed")}>
            Heal
          </Button>
        </div>
      )}
    </Stack>
  );
}

/** Shares are entered in percent. */
export const shownIn = ({ unit }: GameKind) => (unit === "1" ? { factor: 100, unit: "%" } : { factor: 1, unit });
