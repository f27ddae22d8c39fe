import { Button, Radio } from "@mantine/core";
import { useMemo } from "react";
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
import styles from "./controllers.module.css";
import { GeneratorForm } from "./generator-form";
import { overridden, slotTitle } from "./slots";

/** What a controller puts out that is worth a number beside its name, the first that it has. */
const TOLD = ["rate", "amplitude", "voltage"];
/** Beside it, of those that judge their own estimate, whether to believe it. */
const TRUSTED = "trusted";
const trust = (key: string, value: number) => (key.endsWith(TRUSTED) ? (value ? "" : "not trusted") : undefined);

/** Which controller drives in each slot, what all of them say now, and what comes from outside. */
export function ControllersPanel() {
  const slots = useBench(useShallow((s) => s.bench?.slots));
  const controllers = useBench((s) => s.bench?.controllers);
  const signals = useBench((s) => s.bench?.signals);
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
    <section className={styles.panel} aria-label="Choice">
      {Object.entries(slots).map(([slot, active]) => {
        const taken = overridden(slot, slots, block);
        return (
          <fieldset key={slot} className={styles.slot}>
            <legend>{slotTitle(slot)}</legend>
            <Button
              className={styles.open}
              size="compact-xs"
              variant="subtle"
              onClick={() => {
                useView.setState({ card: `controllers.${active}` });
                showPanel("card");
              }}
            >
              Parameters
            </Button>
            <Radio.Group
              label={slotTitle(slot)}
              labelProps={{ className: "visually-hidden" }}
              value={active}
              onChange={(name) => name !== active && actions.controller(name)}
            >
              {controllersOf(slot, controllers, blocks).map((law) => (
                <div key={law.name} className={styles.row} data-active={law.name === active}>
                  <Radio size="sm" value={law.name} label={law.title} description={<Prose text={law.summary} />} />
                  <div className={styles.told}>
                    <output ref={live(law.name)} />
                    {`${law.name}.${TRUSTED}` in told && (
                      <output className={styles.doubt} ref={live(`${law.name}.${TRUSTED}`)} />
                    )}
                  </div>
                </div>
              ))}
            </Radio.Group>
            {taken && (
              <p className={styles.note}>
                Waits: {taken.title} drives this axis as well. Choose another to hand it back.
              </p>
            )}
          </fieldset>
        );
      })}
      {outside.map((instance) => (
        <fieldset key={instance.id} className={styles.slot}>
          <legend>{instance.title}</legend>
          <GeneratorForm instance={instance} />
        </fieldset>
      ))}
    </section>
  );
}
