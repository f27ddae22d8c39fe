import { Box, Button, NativeSelect } from "@mantine/core";
import { useMemo, useRef, useState } from "react";
import { fits } from "../../api/fits";
import { useMay, useServed } from "../../api/me";
import { useCatalog } from "../../api/use-catalog";
import { openVariant } from "../../bench/open-bench";
import { useBusy } from "../../bench/use-busy";
import type { TakePicture } from "../../picture/picture-menu";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { contestants } from "./contestants";
import { DiagnoserLanes } from "./diagnoser-lanes";
import { LaneTools } from "./lane-tools";
import { Race } from "./race";
import { useLaneTime } from "./use-lane-time";
import { useRunWindow } from "./use-run-window";

const ALL = "";

/** Probabilities by the diagnosers of the bench under the truth: all of them in a race, or one in full. */
export function LanesPanel() {
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const signals = useBench((s) => s.bench?.signals);
  const unlabelled = useBench((s) => s.bench?.record?.labels.length === 0);
  const blind = useBench((s) => s.blind);
  const served = useServed();
  const dtMs = useBench((s) => s.bench?.dt_ms);
  const usual = useRunWindow();
  const [chosenMs, setWindowMs] = useState<number | undefined>(undefined);
  const [wanted, setWanted] = useState(ALL);
  const { windowMs, whole } = chosenMs === undefined ? usual : { windowMs: chosenMs, whole: undefined };
  const time = useLaneTime(windowMs, dtMs, whole);
  const picture = useRef<TakePicture>(null);
  const all = useMemo(
    () => contestants({ diagnosers: diagnosers ?? {}, signals: signals ?? [] }),
    [diagnosers, signals],
  );
  if (all.length === 0)
    return (
      <EmptyState title="No diagnoser on this bench" action={<OfferDiagnoser />}>
        A diagnoser that weighs hypotheses about the device fills these lanes, one for each hypothesis.
      </EmptyState>
    );
  // a bank with a hidden truth has lanes too
  const one = all.length === 1 && (all[0].truth || blind) ? all[0] : all.find((c) => c.id === wanted && c.truth);
  return (
    <div className="view">
      {all.length > 1 && (
        <Box className="row" flex="none" p="6px 8px 4px 12px">
          <NativeSelect
            aria-label="Diagnosers shown"
            value={one?.id ?? ALL}
            data={[
              { value: ALL, label: `Race of all ${all.length}` },
              ...all
                .filter((c) => c.truth)
                .map((c) => ({ value: c.id, label: `${c.id.replaceAll("_", " ")} in full` })),
            ]}
            onChange={(e) => setWanted(e.currentTarget.value)}
          />
          <Box component="span" className="remark" flex="1 1 140px">
            {served && "Click a sample to see why"}
          </Box>
          {!one && <LaneTools time={time} onWindow={setWindowMs} take={() => picture.current?.()} />}
        </Box>
      )}
      {one ? (
        <DiagnoserLanes
          id={one.id}
          names={one.names}
          withTruth={one.truth && !unlabelled}
          time={time}
          onWindow={setWindowMs}
        />
      ) : (
        <Race contestants={all} time={time} picture={picture} />
      )}
    </div>
  );
}

const USUAL = "mmae";

/** Begin the bench again with a bank of hypotheses that suits its plant. */
function OfferDiagnoser() {
  const axes = useBench((s) => s.bench?.axes) ?? [];
  const replay = useBench((s) => s.bench?.replay_of);
  const { blocks } = useCatalog();
  const [wanted, setWanted] = useState(USUAL);
  const [busy, during] = useBusy();
  const teaches = useMay("teach");
  const banks = blocks.filter(
    (b) => b.family === "diagnose" && fits(b, axes) && b.parameters.some((p) => p.name === "hypotheses"),
  );
  const bank = banks.find((b) => b.name === wanted) ?? banks[0];
  if (!bank || replay || !teaches) return null; // the past cannot be changed
  const begin = () => {
    void during(() =>
      openVariant({ [`diagnosers.${bank.name}`]: { kind: bank.name } }, `The bench restarts with ${bank.title}.`),
    );
  };
  return (
    <>
      <NativeSelect
        aria-label="Diagnoser to add"
        value={bank.name}
        data={banks.map((b) => ({ value: b.name, label: b.title }))}
        onChange={(e) => setWanted(e.currentTarget.value)}
      />
      <Button variant="filled" size="xs" loading={busy} onClick={begin}>
        Restart with it
      </Button>
    </>
  );
}
