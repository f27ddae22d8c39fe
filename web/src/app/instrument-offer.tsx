import { Button, NativeSelect } from "@mantine/core";
import { IconAccessPoint } from "@tabler/icons-react";
import { useState } from "react";
import { instruments } from "../api/instruments";
import { useAnswer } from "../api/queries";
import type { MeasuredDevice, ScenarioSummary } from "../api/types";
import { openOwn } from "../bench/open-bench";
import { useBusy } from "../bench/use-busy";
import { useView } from "../bench/view-store";
import { formatSi } from "../ui/format";
import styles from "./dialogs.module.css";

const LOOK_MS = 2000;
const USUAL = "first-look";

interface InstrumentOfferProps {
  scenarios: ScenarioSummary[];
  devices: MeasuredDevice[];
}

/**
 * The instruments that send now, and a bench on each with the banks of a scenario and a calibrated device; nothing where
 * none sends.
 */
export function InstrumentOffer({ scenarios, devices }: InstrumentOfferProps) {
  const { value } = useAnswer(["instruments"], instruments.all, () => LOOK_MS);
  const [scenario, setScenario] = useState(USUAL);
  const [device, setDevice] = useState("");
  const [busy, during] = useBusy<string>();
  const sending = value?.filter((one) => one.is_connected) ?? [];
  if (!sending.length) return null;

  const open = (name: string) =>
    during(async () => {
      openOwn((await instruments.open(name, scenario, device)).id);
      useView.setState({ dialog: "none" });
    }, name);

  return (
    <section aria-label="Instruments">
      <h3 className={styles.heading}>Instruments</h3>
      <NativeSelect
        label="Diagnosers of"
        value={scenario}
        data={scenarios.map((one) => ({ value: one.id, label: one.title }))}
        onChange={(e) => setScenario(e.currentTarget.value)}
      />
      {devices.length > 0 && (
        <NativeSelect
          label="Device that they assume"
          value={device}
          data={[
            { value: "", label: "nominal, not calibrated" },
            ...devices.map(({ id, name }) => ({ value: id, label: `${name}, measured` })),
          ]}
          onChange={(e) => setDevice(e.currentTarget.value)}
        />
      )}
      {sending.map((one) => (
        <Button
          key={one.name}
          fullWidth
          size="xs"
          mt="xs"
          variant="light"
          leftSection={<IconAccessPoint size={16} />}
          loading={busy === one.name}
          onClick={() => open(one.name)}
        >
          {one.name}, live at {formatSi(one.rate_khz, "kHz", 3)}
        </Button>
      ))}
    </section>
  );
}
