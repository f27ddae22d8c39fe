import { useBench } from "../../stream/bench-store";
import { useBoardState, useStaleSince } from "../../stream/freshness";
import { StateDot } from "../../ui/state-dot";

/** The present state of the board, or of the connection while it is unknown. */
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
