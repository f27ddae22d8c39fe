import { Radio } from "@mantine/core";
import { api } from "../../api/api";
import { useAnswer } from "../../api/queries";
import type { MeasuredPlant } from "../../api/types";
import { useCatalog } from "../../api/use-catalog";
import { send } from "../../bench/send";
import { useBench } from "../../stream/bench-store";
import { formatSi } from "../../ui/format";
import { Weaknesses } from "../../ui/weaknesses";

/** The model of the device, chosen while the bench runs, and the time of a tick with each. */
export function PlantChoice() {
  const id = useBench((s) => s.bench?.id);
  const model = useBench((s) =>
    String((s.bench?.parameters.plant as { model?: string } | undefined)?.model ?? "linear"),
  );
  const axes = useBench((s) => s.bench?.axes.join());
  const dtMs = useBench((s) => s.bench?.dt_ms ?? 0);
  const { blocks, block } = useCatalog();
  const { value } = useAnswer(id ? ["plants", id] : undefined, () => api.plants(id ?? ""));
  const tickNs = dtMs * 1e6;

  return (
    <>
      <Radio.Group
        label="Plant"
        labelProps={{ className: "visually-hidden" }}
        value={model}
        onChange={(name) =>
          void send({ set: { "plant.model": name } }, `Plant: ${block("plant", name)?.title ?? name}`)
        }
      >
        {blocks
          .filter((b) => b.family === "plant" && b.axes?.join() === axes)
          .map((b) => {
            const cost = value?.plants.find((c) => c.name === b.name);
            return (
              <Radio
                key={b.name}
                p="4px 0"
                size="sm"
                value={b.name}
                label={b.title}
                description={describe(cost, tickNs)}
              />
            );
          })}
      </Radio.Group>
      <Weaknesses of={block("plant", model)} />
    </>
  );
}

function describe(cost: MeasuredPlant | undefined, tickNs: number): string {
  if (!cost) return "measuring its cost";
  if (cost.ns_per_tick === null) return `not on this bench: ${cost.refused}`;
  const times = tickNs / cost.ns_per_tick;
  return `${formatSi(cost.ns_per_tick, "ns", 3)} per tick of the whole bench, ${formatSi(times, "", 3)} times as fast as real time`;
}
