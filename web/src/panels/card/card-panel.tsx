import { Box, Button, NativeSelect } from "@mantine/core";
import { IconChevronLeft, IconPencil } from "@tabler/icons-react";
import { useMay } from "../../api/me";
import { useAnswer } from "../../api/queries";
import type { BlockCard } from "../../api/types";
import { units } from "../../api/units";
import { useCatalog } from "../../api/use-catalog";
import { showPanel } from "../../bench/dock";
import { editCopy, editOwn } from "../../bench/edit-unit";
import { sourceOnBench } from "../../bench/unit-values";
import { useView } from "../../bench/view-store";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { Prose } from "../../ui/prose";
import { Weaknesses } from "../../ui/weaknesses";
import { BlockEquation } from "./block-equation";
import { Values } from "./block-values";
import { CatalogueMissing } from "./catalogue-missing";
import { useInstances } from "./instances";
import { LiveValues } from "./live-values";

/** The block that was clicked last: its purpose, its equations and its parameters. */
export function CardPanel() {
  const card = useView((s) => s.card);
  const parameters = useBench((s) => s.bench?.parameters);
  const controller = useBench((s) => s.bench?.controller);
  const list = useInstances();
  const drives = useMay("drive");
  const { blocks, block } = useCatalog();
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
      <div className="row">
        <Button leftSection={<IconChevronLeft size={15} />} onClick={() => showPanel("schematic")}>
          Diagram
        </Button>
        <NativeSelect
          flex={1}
          miw={0}
          aria-label="Block"
          value={instance.id}
          data={options}
          onChange={(e) => useView.setState({ card: e.currentTarget.value })}
        />
      </div>
      {found ? (
        <>
          <Box component="h2" m="12px 0 4px" fz="lg">
            {found.title}
          </Box>
          <Box component="p" className="note" mb={8}>
            <Prose text={found.summary} />
          </Box>
          <EditUnit block={found} />
          <Weaknesses of={found} />
          {found.equations.length > 0 && (
            <Box p="4px 0" fz="md" style={{ borderTop: "1px solid var(--line)" }}>
              {found.equations.map((equation) => (
                <BlockEquation key={equation.label + equation.latex} equation={equation} />
              ))}
            </Box>
          )}
          <LiveValues key={`live ${instance.id} ${instance.name}`} instance={instance} />
          {!drives && <p className="note">You watch this bench; its values cannot be changed here.</p>}
          <Values instance={instance} />
        </>
      ) : (
        <CatalogueMissing loading={blocks.length ? "Not in the catalogue" : "Loading the catalogue"}>
          {instance.family} {instance.name}
        </CatalogueMissing>
      )}
    </section>
  );
}

/** The way from a block to its text: an own unit is edited, a unit of the library is copied. */
function EditUnit({ block: { family, name } }: { block: BlockCard }) {
  const teaches = useMay("teach");
  const isOwn = useBench((s) => sourceOnBench(s.bench?.parameters, name) !== undefined);
  const { value } = useAnswer(teaches ? ["texts of units"] : undefined, units.all);
  if (!teaches || !value || value.refusal) return null;
  const canCopy = value.units.some((one) => one.family === family && one.name === name);
  if (!isOwn && !canCopy) return null;
  return (
    <Button
      variant="subtle"
      leftSection={<IconPencil size={14} />}
      onClick={() => (isOwn ? editOwn(name) : void editCopy(name))}
    >
      {isOwn ? "Edit" : "Edit a copy"}
    </Button>
  );
}
