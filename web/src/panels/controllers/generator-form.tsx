import { NativeSelect } from "@mantine/core";
import { fits } from "../../api/fits";
import type { Parameter } from "../../api/types";
import { useCatalog } from "../../api/use-catalog";
import { send } from "../../bench/send";
import { useBench } from "../../stream/bench-store";
import type { Instance } from "../card/instances";
import { ParameterList } from "../card/parameter-list";

/** An input from outside: its kind, and the numbers of this kind. */
export function GeneratorForm({ instance }: { instance: Instance }) {
  const document = useBench((s) => s.bench?.parameters);
  const { block } = useCatalog();
  const card = block(instance.family, instance.name);
  if (!document || !card) return null;
  return (
    <>
      <KindChoice instance={instance} />
      <ParameterList
        key={instance.name}
        blocks={[{ instance, parameters: noiseLast(card.parameters) }]}
        document={document}
      />
    </>
  );
}

/** The parameters of a rate before the parameters of its noise. */
const noiseLast = (parameters: Parameter[]) => [
  ...parameters.filter((p) => p.equation !== "noise"),
  ...parameters.filter((p) => p.equation === "noise"),
];

/** Another kind of the same family, at once. */
export function KindChoice({ instance }: { instance: Instance }) {
  const axes = useBench((s) => s.bench?.axes) ?? [];
  const { blocks } = useCatalog();
  return (
    <NativeSelect
      mb={6}
      aria-label={`Kind of ${instance.title.toLowerCase()}`}
      value={instance.name}
      data={blocks
        .filter((b) => b.family === instance.family && fits(b, axes))
        .map((b) => ({ value: b.name, label: b.title }))}
      onChange={(e) =>
        void send(
          { set: { [`${instance.path}.kind`]: e.currentTarget.value } },
          `${instance.title} ${e.currentTarget.value}`,
        )
      }
    />
  );
}
