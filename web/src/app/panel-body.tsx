import { useBench } from "../stream/bench-store";
import { EmptyState } from "../ui/empty-state";
import { ErrorFence } from "../ui/error-fence";
import type { PanelKind, PanelProps } from "./panels";

/** A panel of a kind, fenced; what changes a bench has no place on one that plays a recording. */
export function PanelBody({ kind, params, setParams }: PanelProps & { kind: PanelKind }) {
  const replay = useBench((s) => s.bench?.replay_of);
  return (
    <ErrorFence name={kind.title}>
      {replay && kind.changes ? (
        <EmptyState title="The past cannot be changed">
          A recording is played here; what was done then stands under Events. Leave the replay to go on.
        </EmptyState>
      ) : (
        <kind.component params={params} setParams={setParams} />
      )}
    </ErrorFence>
  );
}
