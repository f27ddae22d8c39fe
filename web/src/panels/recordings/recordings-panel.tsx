import { useState } from "react";
import { api } from "../../api/api";
import { useMay } from "../../api/me";
import { usePanelVisible } from "../../api/panel-visible";
import { useAnswer } from "../../api/queries";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import rows from "../../ui/row-list.module.css";
import { Stale } from "../../ui/stale";
import { CompareView } from "./compare-view";
import { RecordForm } from "./record-form";
import { RecordingRow } from "./recording-row";

const BUSY_MS = 1000;
const CALM_MS = 10_000;

/** Every signal at full rate, kept: record, replay, download, compare. */
export function RecordingsPanel() {
  return usePanelVisible() ? <Recordings /> : null;
}

function Recordings() {
  const bench = useBench((s) => s.bench?.id);
  const drives = useMay("drive");
  const replay = useBench((s) => s.bench?.replay_of);
  const underWay = useBench((s) => (s.bench?.recording.length ?? 0) + (s.bench?.armed.length ?? 0));
  const { value, error, since, again } = useAnswer(["recordings"], api.recordings, (list) =>
    underWay > 0 || list?.some((one) => !one.finished) ? BUSY_MS : CALM_MS,
  );
  const [first, setFirst] = useState<string | undefined>(undefined);
  const comparing = value?.find((one) => one.id === first);

  return (
    <section className={rows.panel} aria-label="Recordings">
      {bench && !replay && drives && <RecordForm onChanged={again} />}
      <Stale error={error} since={since} onRetry={again} />
      {comparing && value && (
        <CompareView key={comparing.id} first={comparing} others={value} onClose={() => setFirst(undefined)} />
      )}
      {value?.length === 0 ? (
        <EmptyState title="Nothing recorded yet">
          Record now, or set a condition and leave it waiting: the moments before it are kept too.
        </EmptyState>
      ) : (
        <ul>
          {value?.map((recording) => (
            <RecordingRow
              key={recording.id}
              recording={recording}
              isHere={recording.bench_id === bench}
              onCompare={() => setFirst(recording.id)}
              onChanged={again}
            />
          ))}
        </ul>
      )}
    </section>
  );
}
