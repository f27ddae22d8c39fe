import { useMay } from "../api/me";
import { useBench } from "../stream/bench-store";
import { EmptyState } from "../ui/empty-state";
import { ErrorFence } from "../ui/error-fence";
import { type PanelKind, type PanelProps, suits } from "./panels";

/** A panel of a kind, fenced; what changes a bench has no place on one that plays a recording, what needs more than is served none while a fault is to be found. */
export function PanelBody({ kind, params, setParams }: PanelProps & { kind: PanelKind }) {
  const fitting = useBench((s) => suits(kind, s.bench));
  const replay = useBench((s) => s.bench?.replay_of);
  const blind = useBench((s) => s.blind);
  const playing = useBench((s) => s.bench?.blind?.game);
  const drives = useMay("drive");
  return (
    <ErrorFence name={kind.title}>
      {!fitting ? (
        <EmptyState title="Not on this bench">
          {kind.only === "axes"
            ? `${kind.title} is for a gyroscope. Choose one in the designer and use it on the bench.`
            : `${kind.title} is for a device with one displacement; this one moves along several axes.`}
        </EmptyState>
      ) : playing && !kind.whileBlind ? (
        <EmptyState title="Hidden while the game is played">
          The server hides what this panel shows until you have handed in for the last time under Games.
        </EmptyState>
      ) : blind && !kind.whileBlind ? (
        <EmptyState title="Hidden while you look for the fault">
          The server hides what this panel shows until you answer under Blind diagnosis.
        </EmptyState>
      ) : replay && kind.changes ? (
        <EmptyState title="The past cannot be changed">
          A recording is played here; what was done then stands under Events. Leave the replay to go on.
        </EmptyState>
      ) : !drives && kind.changes ? (
        <EmptyState title="You watch this bench">What is done on it stands under Events.</EmptyState>
      ) : (
        <kind.component params={params} setParams={setParams} />
      )}
    </ErrorFence>
  );
}
