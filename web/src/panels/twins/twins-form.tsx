import { Button, Group, NativeSelect } from "@mantine/core";
import { IconPlus, IconX } from "@tabler/icons-react";
import { useState } from "react";
import { useShallow } from "zustand/react/shallow";
import { controllersOf } from "../../api/fits";
import { useCatalog } from "../../api/use-catalog";
import { useBench } from "../../stream/bench-store";
import { slotTitle } from "../controllers/slots";
import { RestartButton } from "../restart/restart-button";
import { twinsOf } from "./boards";

const MOST = 3;
const WORTH_SEEING = [
  ...["mrac", "stvsc", "pid", "indirect_mrac", "self_sliding"],
  ...["force_to_rebalance", "open_loop_rate", "drive_tracking"],
];

/** Choose the controllers of the twins, which meet the same reference, noise and faults. */
export function TwinsForm({ chosen }: { chosen: string[] }) {
  const controllers = useBench((s) => s.bench?.controllers) ?? [];
  const slots = useBench(useShallow((s) => s.bench?.slots)) ?? {};
  const { block, blocks } = useCatalog();
  const drives = (name: string) => Object.values(slots).includes(name);
  const slotOf = (name: string) => block("control", name)?.slot ?? "";
  const last = Object.keys(slots).at(-1);
  const [kinds, setKinds] = useState(
    chosen.length ? chosen : WORTH_SEEING.filter((name) => controllers.includes(name) && !drives(name)).slice(0, 2),
  );
  const itemsOf = (slot: string) =>
    controllersOf(slot, controllers, blocks).map(({ name, title }) => ({ value: name, label: title }));
  const names = Object.keys(slots);
  const options =
    names.length > 1 ? names.map((slot) => ({ group: slotTitle(slot), items: itemsOf(slot) })) : names.flatMap(itemsOf);
  return (
    <Group gap="4px 8px" flex={chosen.length ? 1 : undefined} justify={chosen.length ? undefined : "center"}>
      {kinds.map((kind, i) => (
        // biome-ignore lint/suspicious/noArrayIndexKey: a twin is known by its place until it has its name
        <Group key={i} gap={0} wrap="nowrap">
          <NativeSelect
            aria-label={`Controller of twin ${i + 1}`}
            value={kind}
            data={options}
            onChange={(e) => {
              const next = e.currentTarget.value;
              setKinds(kinds.map((k, j) => (j === i ? next : k)));
            }}
          />
          <Button
            variant="subtle"
            aria-label={`Leave out twin ${i + 1}`}
            onClick={() => setKinds(kinds.filter((_, j) => j !== i))}
          >
            <IconX size={14} />
          </Button>
        </Group>
      ))}
      {kinds.length < MOST && (
        <Button
          variant="light"
          leftSection={<IconPlus size={14} />}
          disabled={controllers.length === 0}
          onClick={() =>
            setKinds([...kinds, controllers.find((name) => !drives(name) && !kinds.includes(name)) ?? controllers[0]])
          }
        >
          Twin
        </Button>
      )}
      <RestartButton
        variant="filled"
        disabled={kinds.length === 0 && chosen.length === 0}
        set={{ twins: twinsOf(kinds, (name) => (slotOf(name) === last ? undefined : slotOf(name))) }}
        said={kinds.length ? "The bench restarts with its twins." : "The twins were removed."}
      >
        {kinds.length === 0 ? "Restart without twins" : "Restart with these"}
      </RestartButton>
    </Group>
  );
}
