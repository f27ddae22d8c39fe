import { Box } from "@mantine/core";
import { useShallow } from "zustand/react/shallow";
import { useCatalog } from "../../api/use-catalog";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { BlockValues } from "./block-values";

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
