import { Button, NativeSelect, Switch } from "@mantine/core";
import { useRef, useState } from "react";
import { fits } from "../../api/fits";
import type { BlockCard, Document } from "../../api/types";
import { useCatalog } from "../../api/use-catalog";
import { send } from "../../bench/send";
import { useBench } from "../../stream/bench-store";
import { Prose } from "../../ui/prose";
import { Weaknesses } from "../../ui/weaknesses";
import styles from "./device.module.css";

const BYPASS = "ideal";

/** Whether a sensor gives a displacement, so that a controller can be fed by it. */
export const feeds = (sensor: BlockCard) => sensor.outputs.some((port) => port.name === "displacement");

/** Which sensor feeds the controllers; the bypass is the ideal one, which sees the true displacement. */
export function SensorChoice() {
  const parameters = useBench((s) => s.bench?.parameters);
  const axes = useBench((s) => s.bench?.axes) ?? [];
  const { blocks } = useCatalog();
  const [last, setLast] = useState("capacitive");
  // What was chosen last counts until the board has answered: the next click is meant from there.
  const [wanted, setWanted] = useState<string | undefined>(undefined);
  const choice = useRef(0);
  const kind = wanted ?? String((parameters?.sensor as Document | undefined)?.kind ?? BYPASS);
  const sensors = blocks.filter((b) => b.family === "sense" && fits(b, axes));
  const choices = sensors.filter(feeds);
  const chosen = sensors.find((b) => b.name === kind);
  const optical = sensors.filter((b) => !feeds(b));
  const always = (name: string) =>
    Boolean(((parameters?.sensors as Document | undefined)?.[name] as Document | undefined)?.always);
  const use = async (name: string) => {
    choice.current += 1;
    const own = choice.current;
    if (kind !== BYPASS) setLast(kind);
    setWanted(name);
    await send({ set: { "sensor.kind": name } }, `Sensor: ${sensors.find((b) => b.name === name)?.title ?? name}`);
    if (own === choice.current) setWanted(undefined);
  };
  return (
    <>
      <div className={styles.line}>
        <NativeSelect
          flex={1}
          size="xs"
          aria-label="Sensor that feeds the controllers"
          value={kind}
          data={choices.map((b) => ({ value: b.name, label: b.title }))}
          onChange={(event) => void use(event.currentTarget.value)}
        />
        {sensors.some((b) => b.name === BYPASS) && (
          <Button
            size="xs"
            variant={kind === BYPASS ? "filled" : "default"}
            aria-pressed={kind === BYPASS}
            title="Feed the controllers with the true displacement"
            onClick={() => void use(kind === BYPASS ? last : BYPASS)}
          >
            Bypass
          </Button>
        )}
      </div>
      {chosen && (
        <>
          <p className={styles.note}>
            <Prose text={chosen.summary} />
          </p>
          <Weaknesses of={chosen} />
        </>
      )}
      {optical.length > 0 && (
        <>
          <p className={styles.note}>
            Light and its recovery rest at 0 until the sensor in use needs them. Keep one running to watch it:
          </p>
          {optical.map((b) => (
            <Switch
              key={b.name}
              size="xs"
              mb={6}
              label={b.title}
              checked={always(b.name)}
              onChange={(event) =>
                void send(
                  { set: { [`sensors.${b.name}.always`]: event.currentTarget.checked } },
                  `${b.title} ${event.currentTarget.checked ? "always runs" : "rests until needed"}`,
                )
              }
            />
          ))}
        </>
      )}
    </>
  );
}
