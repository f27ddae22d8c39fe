import { Box, Button } from "@mantine/core";
import { useMemo } from "react";
import type { BlockCard } from "../../api/types";
import { actions } from "../../bench/actions";
import { addScope, showPanel } from "../../bench/dock";
import { useView } from "../../bench/view-store";
import { useBench } from "../../stream/bench-store";

const MOST_TRACES = 6;

/** The role of a unit on the bench, and its actions there. */
export function OnBench({ card }: { card: BlockCard }) {
  const signals = useBench((s) => s.bench?.signals);
  const drives = useBench((s) => Object.values(s.bench?.slots ?? {}).includes(card.name));
  const isThere = useBench((s) => s.bench?.controllers.includes(card.name));
  const own = useMemo(
    () => (signals ?? []).filter((s) => s.block === card.name).map((s) => s.name),
    [signals, card.name],
  );
  return (
    <Box className="row" pb={8} style={{ borderBottom: "1px solid var(--line)" }}>
      {card.family === "control" &&
        (drives ? (
          <span>It drives.</span>
        ) : (
          isThere && (
            <>
              <span>In shadow: it computes, and another controller drives.</span>
              <Button variant="filled" onClick={() => actions.controller(card.name)}>
                Let it drive
              </Button>
            </>
          )
        ))}
      {card.family === "faults" && <Button onClick={() => showPanel("faults")}>Inject it under Faults</Button>}
      {card.family === "sense" && <Button onClick={() => showPanel("sensor")}>Choose it under Device › Sensor</Button>}
      {card.family === "reference" && (
        <Button
          onClick={() => {
            useView.setState({ card: "reference" });
            showPanel("card");
          }}
        >
          Choose it in the block of the reference
        </Button>
      )}
      {own.length > 0 && (
        <Button onClick={() => addScope(card.title, own.slice(0, MOST_TRACES), "time")}>Show its signals</Button>
      )}
    </Box>
  );
}
