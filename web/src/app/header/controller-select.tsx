import { useMediaQuery } from "@mantine/hooks";
import { useShallow } from "zustand/react/shallow";
import { controllersOf } from "../../api/fits";
import { useCatalog } from "../../api/use-catalog";
import { actions } from "../../bench/actions";
import { slotTitle } from "../../panels/controllers/slots";
import { useBench } from "../../stream/bench-store";
import { HeaderSelect, useLocked } from "./header-select";

/**
 * Which controller drives the device, in each slot; the others run in their shadow, so a change is bumpless.
 *
 * A narrow page has room for the last slot alone; the panel of controllers has all slots.
 */
export function ControllerSelect() {
  const slots = useBench(useShallow((s) => s.bench?.slots));
  const wide = useMediaQuery("(min-width: 1800px)", undefined, { getInitialValueInEffect: false });
  const all = Object.entries(slots ?? { "": undefined });
  const active = wide ? all : all.slice(-1);
  return active.map(([slot, name]) => <SlotSelect key={slot} slot={slot} active={name} />);
}

function SlotSelect({ slot, active }: { slot: string; active: string | undefined }) {
  const controllers = useBench((s) => s.bench?.controllers);
  const locked = useLocked();
  const { blocks } = useCatalog();
  return (
    <HeaderSelect
      label={slotTitle(slot)}
      value={active}
      choices={controllersOf(slot, controllers ?? [], blocks).map(({ name, title, summary }) => ({
        value: name,
        title,
        about: summary,
      }))}
      locked={locked}
      onChoose={actions.controller}
    />
  );
}
