import { Button, TextInput } from "@mantine/core";
import { useState } from "react";
import { api } from "../../api/api";
import { useMay, useWatches } from "../../api/me";
import { usePanelVisible } from "../../api/panel-visible";
import { useAnswer } from "../../api/queries";
import { showing } from "../../bench/send";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import rows from "../../ui/row-list.module.css";
import { Stale } from "../../ui/stale";
import { SetDifference } from "./set-difference";
import { SetRow } from "./set-row";

const EVERY_MS = 10_000;

/** Values of the bench under a name: kept, put back in one tick, compared. */
export function SetsPanel() {
  const watches = useWatches();
  const visible = usePanelVisible();
  if (watches) return <EmptyState title="No sets here">A link to watch shows one bench.</EmptyState>;
  return visible ? <Sets /> : null;
}

function Sets() {
  const bench = useBench((s) => s.bench?.id) ?? "";
  const { value: sets, error, since, again } = useAnswer(["parameter sets"], api.parameterSets, () => EVERY_MS);
  const [name, setName] = useState("");
  const teaches = useMay("teach");
  const [chosen, setChosen] = useState<string | undefined>(undefined);
  const comparing = sets?.find((one) => one.id === chosen);
  const keep = showing(async () => {
    await api.saveParameterSet(bench, name.trim());
    setName("");
    again();
  });
  return (
    <section className={rows.panel} aria-label="Sets">
      {teaches && (
        <form
          className={rows.form}
          onSubmit={(event) => {
            event.preventDefault();
            void keep();
          }}
        >
          <TextInput
            label="Keep the values of now as"
            placeholder="soft PID, lecture 3"
            maxLength={100}
            value={name}
            onChange={(e) => setName(e.currentTarget.value)}
          />
          <Button variant="filled" type="submit" size="xs" disabled={!name.trim()}>
            Keep
          </Button>
        </form>
      )}
      <Stale error={error} since={since} onRetry={again} />
      {comparing && sets && (
        <SetDifference key={comparing.id} first={comparing} others={sets} onClose={() => setChosen(undefined)} />
      )}
      {sets?.length === 0 ? (
        <EmptyState title="No set yet">
          A set holds every value that may change while the bench runs.{" "}
          {teaches
            ? "Keep one, change what you like, and put it back in one tick."
            : "The teacher keeps some here; you can put them on your bench in one tick."}
        </EmptyState>
      ) : (
        <ul>
          {sets?.map((one) => (
            <SetRow key={one.id} set={one} bench={bench} onCompare={() => setChosen(one.id)} onChanged={again} />
          ))}
        </ul>
      )}
    </section>
  );
}
