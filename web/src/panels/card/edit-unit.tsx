import { Button } from "@mantine/core";
import { IconPencil } from "@tabler/icons-react";
import { useMay } from "../../api/me";
import { useAnswer } from "../../api/queries";
import type { BlockCard } from "../../api/types";
import { units } from "../../api/units";
import { editCopy, editOwn } from "../../bench/edit-unit";
import { sourceOnBench } from "../../bench/unit-values";
import { useBench } from "../../stream/bench-store";

/** The way from a block to its text: an own unit is edited, a unit of the library is copied. */
export function EditUnit({ block: { family, name } }: { block: BlockCard }) {
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
