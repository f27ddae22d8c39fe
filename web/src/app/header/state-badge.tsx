import { useBench } from "../../stream/bench-store";
import { useBoardState, useStaleSince } from "../../stream/freshness";
import { StateDot } from "../../ui/state-dot";

/** What the board does right now, or that we do not know. */
export function StateBadge() {
  const shown = useBoardState();
  const phase = useBench((s) => s.connection.phase);
  const stale = useStaleSince() !== undefined;
  const unknown = { waiting: "reconnecting", closed: "not connected" }[phase as string];
  return (
    <StateDot state={shown ?? "unknown"} miw="9.5ch" data-testid="bench-state">
      {shown ?? unknown ?? (stale ? "silent" : "connecting")}
    </StateDot>
  );
}
