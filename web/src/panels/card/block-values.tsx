import { Box } from "@mantine/core";
import { useShallow } from "zustand/react/shallow";
import { useMay } from "../../api/me";
import { useCatalog } from "../../api/use-catalog";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { KindChoice } from "../controllers/generator-form";
import { type Instance, useInstances } from "./instances";
import { ParameterList } from "./parameter-list";

/** Families whose kind is changed while the bench runs. */
const GENERATORS = ["reference", "rate"];

/** The parameters of the block with an id, if the bench has it. */
export function BlockValues({ id }: { id: string }) {
  const instance = useInstances().find((one) => one.id === id);
  return instance ? <Values instance={instance} /> : null;
}

/** The parameters of several blocks, each under its title, which may be changed together. */
export function TitledValues({ ids }: { ids: readonly string[] }) {
  const parameters = useBench((s) => s.bench?.parameters);
  const drives = useMay("drive");
  const { block } = useCatalog();
  const list = useInstances();
  const blocks = ids.flatMap((id) => {
    const instance = list.find((one) => one.id === id);
    const found = instance && block(instance.family, instance.name);
    if (!instance || !found || found.parameters.length === 0) return [];
    return [{ title: found.title, instance, parameters: found.parameters }];
  });
  if (!parameters || blocks.length === 0) return null;
  return (
    <fieldset disabled={!drives}>
      <ParameterList blocks={blocks} document={parameters} />
    </fieldset>
  );
}

/** The parameters of a block on the bench; a watcher cannot change them. */
export function Values({ instance }: { instance: Instance }) {
  const parameters = useBench((s) => s.bench?.parameters);
  const drives = useMay("drive");
  const { block } = useCatalog();
  const found = block(instance.family, instance.name);
  if (!parameters || !found) return null;
  return (
    <fieldset disabled={!drives}>
      {GENERATORS.includes(instance.family) && <KindChoice instance={instance} />}
      <ParameterList
        key={`${instance.id} ${instance.name}`}
        blocks={[{ instance, parameters: found.parameters }]}
        document={parameters}
      />
    </fieldset>
  );
}

/** The parameters of the controllers that drive, each under its name. */
export function ParametersView() {
  const active = useBench(useShallow((s) => Object.values(s.bench?.slots ?? {})));
  const { block } = useCatalog();
  if (active.length === 0)
    return <EmptyState title="No bench yet">The parameters of the active controller are set here.</EmptyState>;
  return (
    <section className="view-page" aria-label="Parameters">
      {active.map((name) => (
        <section key={name} aria-label={block("control", name)?.title ?? name}>
          <Box component="h2" m="12px 0 4px" fz="lg">
            {block("control", name)?.title ?? name}
          </Box>
          <BlockValues id={`controllers.${name}`} />
        </section>
      ))}
    </section>
  );
}
