import { Button } from "@mantine/core";
import { send } from "../bench/send";
import { useBench } from "../stream/bench-store";
import { sentence } from "../ui/capital";
import { formatSi } from "../ui/format";
import { NoticeLine } from "./notice-line";

/**
 * Where the bench plays a record: how long it is, and that it has a truth only by its labels; where an instrument sends
 * it, whether it still does.
 */
export function RecordLine() {
  const bench = useBench((s) => (s.bench?.record ? s.bench : undefined));
  if (!bench?.record) return null;
  const { samples, labels } = bench.record;
  const { instrument } = bench;
  const live = instrument?.is_connected ? "it is measured now." : "the instrument is gone; the bench waits for it.";
  const truth =
    labels.length > 0
      ? "Its labels are the truth."
      : "It has no labels: the truth is not known, and there are verdicts without a score.";
  return (
    <NoticeLine
      label="Record"
      tone={instrument && !instrument.is_connected ? "warn" : "note"}
      title={instrument ? `${instrument.source}, live:` : "Record:"}
      text={
        instrument
          ? `${instrument.is_growing ? live : sentence(instrument.ended)} ${truth}`
          : `${formatSi(samples * bench.dt_ms, "ms")} of a real device. ${truth}`
      }
    >
      {bench.state !== "tripped" && bench.time_scale !== null && (
        <Button onClick={() => void send({ kind: "time_scale", value: null }, "As fast as it goes")}>
          As fast as it goes
        </Button>
      )}
    </NoticeLine>
  );
}
