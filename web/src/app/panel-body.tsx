import { useMay } from "../api/me";
import type { ViewName } from "../bench/panel-views";
import { useBench } from "../stream/bench-store";
import { EmptyState } from "../ui/empty-state";
import { ErrorFence } from "../ui/error-fence";
import { type PanelProps, suits, VIEW } from "./panels";

/** A view, fenced; what changes a bench has no place on a recording that is played, what needs more than is served none while a fault is hidden. */
export function PanelBody({ view, params, setParams }: PanelProps & { view: ViewName }) {
  const kind = VIEW[view];
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
          The server hides this panel until your last attempt in Lesson, Games.
        </EmptyState>
      ) : blind && !kind.whileBlind ? (
        <EmptyState title="Hidden while you look for the fault">
          The server hides this panel until you answer in Lesson, Hidden fault.
        </EmptyState>
      ) : replay && kind.changes ? (
        <EmptyState title="The past cannot be changed">
          A recording is played here; its commands are listed in Log. Leave the replay to go on.
        </EmptyState>
      ) : !drives && kind.changes ? (
        <EmptyState title="You watch this bench">The commands of its driver are listed in Log.</EmptyState>
      ) : (
        <kind.component params={params} setParams={setParams} />
      )}
    </ErrorFence>
  );
}
