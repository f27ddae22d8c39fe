import { useBench } from "../stream/bench-store";
import { EmptyState } from "../ui/empty-state";
import { ErrorFence } from "../ui/error-fence";
import { type PanelKind, type PanelProps, suits } from "./panels";

/** A panel of a kind, fenced; what changes a bench has no place on one that plays a recording, what tells a fault none while it is to be found. */
export function PanelBody({ kind, params, setParams }: PanelProps & { kind: PanelKind }) {
  const fitting = useBench((s) => suits(kind, s.bench));
  const replay = useBench((s) => s.bench?.replay_of);
  const blind = useBench((s) => s.blind);
  return (
    <ErrorFence name={kind.title}>
      {!fitting ? (
        <EmptyState title="Not on this bench">
          {kind.only === "axes"
            ? `${kind.title} is for a gyroscope. Choose one in the designer and use it on the bench.`
            : `${kind.title} is for a device with one displacement; this one moves along several axes.`}
        </EmptyState>
      ) : blind && kind.tells ? (
        <EmptyState title="Hidden while you look for the fault">
          This panel would show it. It comes back when you commit an answer under Blind diagnosis.
        </EmptyState>
      ) : replay && kind.changes ? (
        <EmptyState title="The past cannot be changed">
          A recording is played here; what was done then stands under Events. Leave the replay to go on.
        </EmptyState>
      ) : (
        <kind.component params={params} setParams={setParams} />
      )}
    </ErrorFence>
  );
}
