import { Button } from "@mantine/core";
import { useState } from "react";
import { fits } from "../../api/fits";
import { useCatalog } from "../../api/use-catalog";
import { actions } from "../../bench/actions";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatCount } from "../../ui/format";
import { groupsOf } from "./fault-draft";
import { FaultRow } from "./fault-row";
import styles from "./faults.module.css";

/** Every fault that this bench may have: what it changes, how much, how and when; several at once. */
export function FaultsPanel() {
  const { blocks, failed, retry } = useCatalog();
  const active = useBench((s) => s.bench?.faults);
  const axes = useBench((s) => s.bench?.axes) ?? [];
  const [open, setOpen] = useState<string | undefined>(undefined);
  const faults = blocks.filter((b) => b.family === "faults" && fits(b, axes));
  if (faults.length === 0)
    return (
      <EmptyState
        title={failed ? "The server did not send the catalogue" : "Loading the faults"}
        action={
          failed && (
            <Button variant="filled" size="xs" onClick={retry}>
              Ask again
            </Button>
          )
        }
      >
        Faults come from the server's catalogue.
      </EmptyState>
    );
  const acting = active?.filter((f) => f.severity !== 0) ?? [];
  return (
    <section className="view" aria-label="Faults">
      <div className={styles.top}>
        <span>{acting.length === 0 ? "The device is healthy" : formatCount(acting.length, "active fault")}</span>
        <Button disabled={acting.length === 0} onClick={actions.healAll}>
          Heal all
        </Button>
      </div>
      <div className={styles.list}>
        {groupsOf(faults).map(([group, members]) => (
          <section key={group} aria-label={group}>
            <h3 className={styles.group}>{group}</h3>
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
      </div>
    </section>
  );
}
