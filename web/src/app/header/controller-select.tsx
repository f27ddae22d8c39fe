import { Select } from "@mantine/core";
import { useCatalog } from "../../api/use-catalog";
import { useBench } from "../../stream/bench-store";
import { actions } from "../actions";

/** Which controller drives the device; the others run in its shadow, so a change is bumpless. */
export function ControllerSelect() {
  const active = useBench((s) => s.bench?.controller);
  const controllers = useBench((s) => s.bench?.controllers);
  const replay = useBench((s) => Boolean(s.bench?.replay_of));
  const { block } = useCatalog();
  return (
    <Select
      size="sm"
      w={190}
      flex="none"
      aria-label="Controller"
      allowDeselect={false}
      value={active ?? null}
      disabled={!controllers || replay}
      data={(controllers ?? []).map((name) => ({
        value: name,
        label: block("control", name)?.title ?? name.replaceAll("_", " "),
      }))}
      onChange={(name) => name && name !== active && actions.controller(name)}
      comboboxProps={{ shadow: "md", width: 300, position: "bottom-start" }}
    />
  );
}
