import { Button, Group, Modal, Text } from "@mantine/core";
import { useState } from "react";
import { api } from "../../api/api";
import { useMay } from "../../api/me";
import { useAsked } from "../../api/queries";
import type { Device, Document } from "../../api/types";
import { useBusy } from "../../bench/use-busy";
import { isDrawnGyroscope, isGyroscope } from "../../designer/design";
import { useBench } from "../../stream/bench-store";
import { formatSi } from "../../ui/format";
import { beginWith, hasUsualBench, plantOf } from "../other-device";
import { HeaderSelect, useLockedWhileHidden } from "./header-select";

const OWN = { value: "own", title: "Own device", about: "Given in the scenario, not in the catalogue" };

const REAL = { value: "real", title: "Real device", about: "The device that was recorded", group: "On this bench" };

/** Which device is on the bench; another one begins the bench again, after a question. */
export function DeviceSelect() {
  const id = useBench((s) => (s.bench?.parameters.device as Document | undefined)?.id as string | undefined);
  const plant = useBench((s) => s.bench && plantOf(s.bench));
  const teaches = useMay("teach");
  const locked = useLockedWhileHidden();
  const { answer: devices = [] } = useAsked(["devices"], api.devices);
  const [asked, setAsked] = useState<Device | undefined>(undefined);
  const [busy, during] = useBusy();
  const suits = (device: Device) => device.plants.includes(plant ?? "");
  const offered = devices.filter((device) => suits(device) || hasUsualBench(device));
  const record = useBench((s) => Boolean(s.bench?.record));
  const choices = record
    ? [REAL]
    : [...offered.filter(suits), ...offered.filter((device) => !suits(device))].map((device) => ({
        value: device.id,
        title: device.title,
        about: deviceWords(device),
        group: suits(device) ? "On this bench" : "On a bench of another kind",
      }));
  const known = devices.find((device) => device.id === id);
  if (!record && !known && devices.length > 0) choices.push({ ...OWN, group: "On this bench" });
  const begin = (device: Device) => during(() => beginWith(device).then(() => setAsked(undefined)));
  return (
    <>
      <HeaderSelect
        label="Device"
        value={record ? REAL.value : (known?.id ?? OWN.value)}
        choices={choices}
        locked={locked}
        onChoose={(name) => setAsked(devices.find((device) => device.id === name))}
      />
      {asked && (
        <Modal
          opened
          centered
          size="sm"
          title={`The bench begins again with ${asked.title}.`}
          withCloseButton={false}
          onClose={() => setAsked(undefined)}
        >
          <Text size="sm">
            {!suits(asked) && "It needs another plant, so a first look at it takes the place of this scenario. "}
            Faults, controller and layout are kept where they suit.
            {!teaches && " The bench you have now is gone."}
          </Text>
          <Group justify="flex-end" mt="md">
            <Button size="sm" onClick={() => setAsked(undefined)}>
              Cancel
            </Button>
            <Button variant="filled" size="sm" loading={busy} data-autofocus onClick={() => begin(asked)}>
              Begin again
            </Button>
          </Group>
        </Modal>
      )}
    </>
  );
}

/** A device in a line of words: its kind, its resonance and its quality factor. */
function deviceWords(device: Device): string {
  const { f0_hz, quality_factor } = device.metrics;
  const kind = isGyroscope(device)
    ? `Gyroscope ${isDrawnGyroscope(device) ? "with a drawing" : "by its figures"}`
    : device.parameters.transfer_function !== undefined
      ? "Transfer function"
      : `Resonator ${device.parameters.geometry ? "with a drawing" : "by its figures"}`;
  const figures = [f0_hz && `f₀ ${formatSi(f0_hz, "Hz", 3)}`, quality_factor && `Q ${formatSi(quality_factor, "", 3)}`];
  return [kind, ...figures.filter(Boolean)].join(", ");
}
