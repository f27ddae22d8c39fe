import { Button } from "@mantine/core";
import { send } from "../bench/send";
import { useBench } from "../stream/bench-store";
import { formatSi } from "../ui/format";
import { NoticeLine } from "./notice-line";

/** Where the bench plays a record: how long it is, and that it has a truth only by its labels. */
export function RecordLine() {
  const bench = useBench((s) => (s.bench?.record ? s.bench : undefined));
  if (!bench?.record) return null;
  const { samples, labels } = bench.record;
  const truth =
    labels.length > 0
      ? "Its labels are the truth."
      : "It has no labels: the truth is not known, and there are verdicts without a score.";
  return (
    <NoticeLine
      label="Record"
      tone="note"
      title="Record:"
      text={`${formatSi(samples * bench.dt_ms, "ms")} of a real device. ${truth}`}
    >
      {bench.state !== "tripped" && bench.time_scale !== null && (
        <Button onClick={() => void send({ kind: "time_scale", value: null }, "As fast as it goes")}>
          As fast as it goes
        </Button>
      )}
    </NoticeLine>
  );
}
