import { Select } from "@mantine/core";
import { useRef } from "react";
import { useCatalog } from "../../api/use-catalog";
import { useBench } from "../../stream/bench-store";
import { actions } from "../actions";

/** Which controller drives the device; the others run in its shadow, so a change is bumpless. */
export function ControllerSelect() {
  const active = useBench((s) => s.bench?.controller);
  const controllers = useBench((s) => s.bench?.controllers);
  const replay = useBench((s) => Boolean(s.bench?.replay_of));
  const closed = useBench((s) => s.connection.phase === "closed");
  const input = useRef<HTMLInputElement>(null);
  const { block } = useCatalog();
  return (
    <Select
      ref={input}
      size="sm"
      w={190}
      flex="none"
      aria-label="Controller"
      allowDeselect={false}
      value={active ?? null}
      disabled={!controllers || replay || closed}
      data={(controllers ?? []).map((name) => ({
        value: name,
        label: block("control", name)?.title ?? name.replaceAll("_", " "),
      }))}
      onChange={(name) => name && name !== active && actions.controller(name)}
      onOptionSubmit={() => input.current?.blur()} // else the list keeps the page's keys
      comboboxProps={{ shadow: "md", width: 300, position: "bottom-start" }}
    />
  );
}
