import { useMay, useServed } from "../api/me";
import type { ViewName } from "../bench/panel-views";
import { useBench } from "../stream/bench-store";
import { EmptyState } from "../ui/empty-state";
import { ErrorFence } from "../ui/error-fence";
import { HiddenView } from "./hidden-view";
import { type PanelProps, servedIn, suits, VIEW } from "./panels";

/** A view, fenced: a view that changes a bench is closed on a recording that is played; tools take the place of a hidden view. */
export function PanelBody({ view, params, setParams }: PanelProps & { view: ViewName }) {
  const kind = VIEW[view];
  const fitting = useBench((s) => suits(kind, s.bench));
  const replay = useBench((s) => s.bench?.replay_of);
  const question = useBench((s) => s.bench?.blind);
  const drives = useMay("drive");
  const here = useServed() || kind.needs === undefined;
  return (
    <ErrorFence name={kind.title}>
      {!here ? (
        <EmptyState title="Not without a server">This page computes its bench, and this view needs more.</EmptyState>
      ) : !fitting ? (
        <EmptyState title="Not on this bench">
          {kind.only === "axes"
            ? `${kind.title} is for a gyroscope. Choose one in the designer and use it on the bench.`
            : `${kind.title} is for a device with one displacement; this one moves along several axes.`}
        </EmptyState>
      ) : question && !servedIn(kind, question) ? (
        <HiddenView key={view} view={view} question={question} />
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
