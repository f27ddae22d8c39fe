import { Box, Button, Group, NativeSelect, Switch } from "@mantine/core";
import { useState } from "react";
import type { Document } from "../../api/types";
import { send } from "../../bench/send";
import { BYPASS, feeds, useSensor } from "../../bench/sensor";
import { useBench } from "../../stream/bench-store";
import { Prose } from "../../ui/prose";
import { Weaknesses } from "../../ui/weaknesses";

/** Which sensor feeds the controllers; the bypass is the ideal one, which sees the true displacement. */
export function SensorChoice() {
  const all = useBench((s) => s.bench?.parameters.sensors) as Document | undefined;
  const { kind, sensors, use } = useSensor();
  const [last, setLast] = useState("capacitive");
  const chosen = sensors.find((b) => b.name === kind);
  const optical = sensors.filter((b) => !feeds(b));
  const always = (name: string) => Boolean((all?.[name] as Document | undefined)?.always);
  const choose = (name: string) => {
    if (kind !== BYPASS) setLast(kind);
    void use(name);
  };
  return (
    <>
      <Group gap={8} wrap="nowrap" align="stretch">
        <NativeSelect
          flex={1}
          aria-label="Sensor that feeds the controllers"
          value={kind}
          data={sensors.filter(feeds).map((b) => ({ value: b.name, label: b.title }))}
          onChange={(event) => choose(event.currentTarget.value)}
        />
        {sensors.some((b) => b.name === BYPASS) && (
          <Button
            size="xs"
            variant={kind === BYPASS ? "filled" : "default"}
            aria-pressed={kind === BYPASS}
            title="Feed the controllers with the true displacement"
            onClick={() => choose(kind === BYPASS ? last : BYPASS)}
          >
            Bypass
          </Button>
        )}
      </Group>
      {chosen && (
        <>
          <Box component="p" className="note" m="6px 0">
            <Prose text={chosen.summary} />
          </Box>
          <Weaknesses of={chosen} />
        </>
      )}
      {optical.length > 0 && (
        <>
          <Box component="p" className="note" m="6px 0">
            Light and its recovery rest at 0 until the sensor in use needs them. Keep one running to watch it:
          </Box>
          {optical.map((b) => (
            <Switch
              key={b.name}
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
