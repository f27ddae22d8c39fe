import { Button, NativeSelect } from "@mantine/core";
import { useState } from "react";
import { fits } from "../../api/fits";
import { useMay } from "../../api/me";
import { useCatalog } from "../../api/use-catalog";
import { openVariant } from "../../bench/open-bench";
import { useBusy } from "../../bench/use-busy";
import { useBench } from "../../stream/bench-store";

const USUAL = "mmae";

/** Begin the bench again with a bank of hypotheses that suits its plant. */
export function OfferDiagnoser() {
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
