import { Box, Button, Group } from "@mantine/core";
import { useState } from "react";
import { fits } from "../../api/fits";
import { useCatalog } from "../../api/use-catalog";
import { actions } from "../../bench/actions";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatCount } from "../../ui/format";
import { CatalogueMissing } from "../card/catalogue-missing";
import { groupsOf } from "./fault-draft";
import { FaultRow } from "./fault-row";

/** Every fault that this bench may have: its effect, its severity, its profile and its moment; several at once. */
export function FaultsPanel() {
  const { blocks } = useCatalog();
  const active = useBench((s) => s.bench?.faults);
  const axes = useBench((s) => s.bench?.axes) ?? [];
  const [open, setOpen] = useState<string | undefined>(undefined);
  const plays = useBench((s) => s.bench?.record);
  if (plays)
    return (
      <EmptyState title="No faults on a record">
        The device was measured: no fault of it can be injected now. Its faults are in the record.
      </EmptyState>
    );
  const faults = blocks.filter((b) => b.family === "faults" && fits(b, axes));
  if (faults.length === 0)
    return <CatalogueMissing loading="Loading the faults">Faults come from the server's catalogue.</CatalogueMissing>;
  const acting = active?.filter((f) => f.severity !== 0) ?? [];
  return (
    <section className="view" aria-label="Faults">
      <Group justify="space-between" wrap="nowrap" p="8px 8px 8px 12px" c="dimmed" fz="sm">
        <span>{acting.length === 0 ? "The device is healthy" : formatCount(acting.length, "active fault")}</span>
        <Button flex="none" style={{ visibility: acting.length > 0 ? "visible" : "hidden" }} onClick={actions.healAll}>
          Heal all
        </Button>
      </Group>
      <Box flex={1} style={{ overflowY: "auto" }}>
        {groupsOf(faults).map(([group, members]) => (
          <section key={group} aria-label={group}>
            <Box component="h3" className="remark" p="8px 12px 4px" style={{ borderTop: "1px solid var(--line)" }}>
              {group}
            </Box>
            <ul>
              {members.map((fault) => (
                <FaultRow
                  key={fault.name}
                  fault={fault}
                  active={acting.find((f) => f.name === fault.name)}
                  open={open === fault.name}
                  onToggle={() => setOpen(open === fault.name ? undefined : fault.name)}
                />
              ))}
            </ul>
          </section>
        ))}
      </Box>
    </section>
  );
}
