import { Box, Button, Group, Radio, Stack } from "@mantine/core";
import { type ReactNode, useMemo } from "react";
import { useShallow } from "zustand/react/shallow";
import { controllersOf } from "../../api/fits";
import { useCatalog } from "../../api/use-catalog";
import { actions } from "../../bench/actions";
import { showPanel } from "../../bench/dock";
import { useView } from "../../bench/view-store";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { Prose } from "../../ui/prose";
import { useInstances } from "../card/instances";
import { useLiveValues } from "../schematic/use-live-values";
import { GeneratorForm } from "./generator-form";
import { overridden, slotTitle } from "./slots";
import { Supervisor } from "./supervisor";

/** Outputs with a number beside the name of a controller; the first existing one is shown. */
const TOLD = ["rate", "amplitude", "voltage"];
/** The signal of a controller that judges its own estimate. */
const TRUSTED = "trusted";
const trust = (key: string, value: number) => (key.endsWith(TRUSTED) ? (value ? "" : "not trusted") : undefined);

/** The driving controller of each slot, the outputs of all now, and the inputs from outside. */
export function ControllersPanel() {
  const slots = useBench(useShallow((s) => s.bench?.slots));
  const controllers = useBench((s) => s.bench?.controllers);
  const signals = useBench((s) => s.bench?.signals);
  const plays = useBench((s) => s.bench?.record);
  const supervised = useBench((s) => !!s.bench?.supervisor);
  const { block, blocks } = useCatalog();
  const told = useMemo(() => {
    const names = new Set(signals?.map((s) => s.name));
    return Object.fromEntries(
      (controllers ?? []).flatMap((name) => {
        const output = TOLD.map((port) => `${name}.${port}`).find((signal) => names.has(signal));
        const trusted = `${name}.${TRUSTED}`;
        return [...(output ? [[name, output]] : []), ...(names.has(trusted) ? [[trusted, trusted]] : [])];
      }),
    );
  }, [controllers, signals]);
  const live = useLiveValues(told, trust);
  const list = useInstances();
  if (!slots || !controllers)
    return <EmptyState title="No bench yet">The controllers of the bench appear here.</EmptyState>;
  const driving = Object.values(slots).flatMap((name) => block("control", name)?.inputs.map((port) => port.name) ?? []);
  const outside = list.filter(({ id }) => id === "rate" || id === "reference" || driving.includes(id));
  return (
    <section className="view-page" aria-label="Choice">
      {plays && (
        <p className="note">
          A controller cannot drive a record: the voltage was measured. The controllers here run in shadow, on its
          samples.
        </p>
      )}
      {supervised && (
        <Slot title="Supervisor">
          <Parameters of="supervisor" label="Parameters of the supervisor" />
          <Supervisor />
        </Slot>
      )}
      {Object.entries(slots).map(([slot, active]) => {
        const taken = overridden(slot, slots, block);
        return (
          <Slot key={slot} title={slotTitle(slot)}>
            <Parameters of={`controllers.${active}`} />
            <Radio.Group
              label={slotTitle(slot)}
              labelProps={{ className: "visually-hidden" }}
              value={active}
              onChange={(name) => name !== active && actions.controller(name)}
            >
              {controllersOf(slot, controllers, blocks).map((law) => (
                <Group
                  key={law.name}
                  justify="space-between"
                  wrap="nowrap"
                  gap={12}
                  p="3px 0"
                  data-active={law.name === active}
                >
                  <Radio value={law.name} label={law.title} description={<Prose text={law.summary} />} />
                  <Stack
                    gap={0}
                    flex="none"
                    align="flex-end"
                    fz="sm"
                    {...(law.name === active ? { fw: 600 } : { c: "dimmed" })}
                  >
                    <output ref={live(law.name)} />
                    {`${law.name}.${TRUSTED}` in told && (
                      <Box
                        component="output"
                        c={law.name === active ? "var(--alarm)" : undefined}
                        ref={live(`${law.name}.${TRUSTED}`)}
                      />
                    )}
                  </Stack>
                </Group>
              ))}
            </Radio.Group>
            {taken && (
              <Box component="p" className="note" m="4px 0 0">
                Waits: {taken.title} drives this axis as well. Choose another to hand it back.
              </Box>
            )}
          </Slot>
        );
      })}
      {outside.map((instance) => (
        <Slot key={instance.id} title={instance.title}>
          <GeneratorForm instance={instance} />
        </Slot>
      ))}
    </section>
  );
}

/** The way to the card of a block. */
function Parameters({ of, label }: { of: string; label?: string }) {
  return (
    <Button
      pos="absolute"
      top={-24}
      right={0}
      size="compact-xs"
      variant="subtle"
      aria-label={label}
      onClick={() => {
        useView.setState({ card: of });
        showPanel("card");
      }}
    >
      Parameters
    </Button>
  );
}

function Slot({ title, children }: { title: string; children: ReactNode }) {
  return (
    <Box component="fieldset" pos="relative" mb={12}>
      <Box component="legend" className="remark" p="4px 0" fw={600}>
        {title}
      </Box>
      {children}
    </Box>
  );
}
