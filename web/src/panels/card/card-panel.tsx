import { Button, NativeSelect } from "@mantine/core";
import { IconChevronLeft } from "@tabler/icons-react";
import { useMay } from "../../api/me";
import { useCatalog } from "../../api/use-catalog";
import { showPanel } from "../../bench/dock";
import { useView } from "../../bench/view-store";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { Prose } from "../../ui/prose";
import { Weaknesses } from "../../ui/weaknesses";
import { BlockEquation } from "./block-equation";
import { Values } from "./block-values";
import styles from "./card.module.css";
import { EditUnit } from "./edit-unit";
import { useInstances } from "./instances";
import { LiveValues } from "./live-values";

/** What was last clicked: what the block does, its equations and its parameters. */
export function CardPanel() {
  const card = useView((s) => s.card);
  const parameters = useBench((s) => s.bench?.parameters);
  const controller = useBench((s) => s.bench?.controller);
  const list = useInstances();
  const drives = useMay("drive");
  const { blocks, block, failed, retry } = useCatalog();
  const wanted = card === "controller" ? `controllers.${controller}` : card;
  const instance = list.find((i) => i.id === wanted) ?? list[0];
  if (!instance || !parameters)
    return (
      <EmptyState title="No block chosen">Click a block of the loop to see its equations and parameters.</EmptyState>
    );
  const found = block(instance.family, instance.name);
  const options = list.map((i) => ({
    value: i.id,
    label: `${i.title}: ${block(i.family, i.name)?.title ?? i.name.replaceAll("_", " ")}`,
  }));
  return (
    <section className="view-page" aria-label={`Block: ${found?.title ?? instance.name}`}>
      <div className={`row ${styles.head}`}>
        <Button leftSection={<IconChevronLeft size={15} />} onClick={() => showPanel("schematic")}>
          Diagram
        </Button>
        <NativeSelect
          aria-label="Block"
          value={instance.id}
          data={options}
          onChange={(e) => useView.setState({ card: e.currentTarget.value })}
        />
      </div>
      {found ? (
        <>
          <h2 className={styles.title}>{found.title}</h2>
          <p className={styles.summary}>
            <Prose text={found.summary} />
          </p>
          <EditUnit block={found} />
          <Weaknesses of={found} />
          {found.equations.length > 0 && (
            <div className={styles.equations}>
              {found.equations.map((equation) => (
                <BlockEquation key={equation.label + equation.latex} equation={equation} />
              ))}
            </div>
          )}
          <LiveValues key={`live ${instance.id} ${instance.name}`} instance={instance} />
          {!drives && <p className={styles.summary}>You watch this bench; its values cannot be changed here.</p>}
          <Values instance={instance} />
        </>
      ) : (
        <EmptyState
          title={
            failed
              ? "The server did not send the catalogue"
              : blocks.length
                ? "Not in the catalogue"
                : "Loading the catalogue"
          }
          action={
            failed && (
              <Button variant="filled" size="xs" onClick={retry}>
                Ask again
              </Button>
            )
          }
        >
          {instance.family} {instance.name}
        </EmptyState>
      )}
    </section>
  );
}
