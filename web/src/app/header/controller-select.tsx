import { Select } from "@mantine/core";
import { useMediaQuery } from "@mantine/hooks";
import { useRef } from "react";
import { useShallow } from "zustand/react/shallow";
import { controllersOf } from "../../api/fits";
import { useMay } from "../../api/me";
import type { BlockCard } from "../../api/types";
import { useCatalog } from "../../api/use-catalog";
import { actions } from "../../bench/actions";
import styles from "../../panels/controllers/controllers.module.css";
import { slotTitle } from "../../panels/controllers/slots";
import { useBench } from "../../stream/bench-store";
import { useBoardState } from "../../stream/freshness";
import { Prose } from "../../ui/prose";

/**
 * Which controller drives the device, in each slot; the others run in their shadow, so a change is bumpless.
 *
 * A narrow page has room for that of the last slot; the panel of controllers has all.
 */
export function ControllerSelect() {
  const slots = useBench(useShallow((s) => s.bench?.slots));
  const wide = useMediaQuery("(min-width: 1560px)", undefined, { getInitialValueInEffect: false });
  const all = Object.entries(slots ?? { "": undefined });
  const active = wide ? all : all.slice(-1);
  return active.map(([slot, name]) => <SlotSelect key={slot} slot={slot} active={name} />);
}

function SlotSelect({ slot, active }: { slot: string; active: string | undefined }) {
  const controllers = useBench((s) => s.bench?.controllers);
  const replay = useBench((s) => Boolean(s.bench?.replay_of));
  const unknown = useBoardState() === undefined;
  const drives = useMay("drive");
  const input = useRef<HTMLInputElement>(null);
  const { blocks } = useCatalog();
  const laws = controllersOf(slot, controllers ?? [], blocks);
  return (
    <Select
      ref={input}
      size="sm"
      miw={92}
      flex={`0 1 ${(laws.find((law) => law.name === active)?.title.length ?? 8) + 7}ch`}
      aria-label={slotTitle(slot)}
      title={slotTitle(slot)}
      allowDeselect={false}
      value={active ?? null}
      disabled={!controllers || replay || unknown || !drives}
      data={laws.map(({ name, title }) => ({ value: name, label: title }))}
      renderOption={({ option }) => <ControllerWords law={laws.find((b) => b.name === option.value)} />}
      onChange={(name) => name && name !== active && actions.controller(name)}
      onOptionSubmit={() => input.current?.blur()} // else the list keeps the page's keys
      maxDropdownHeight={420}
      comboboxProps={{ shadow: "md", width: 340, position: "bottom-start" }}
    />
  );
}

/** A controller by its title, and what it does in a line. */
export function ControllerWords({ law }: { law: Pick<BlockCard, "title" | "summary"> | undefined }) {
  return (
    law && (
      <span className={styles.law}>
        {law.title}
        <small>
          <Prose text={law.summary} />
        </small>
      </span>
    )
  );
}
