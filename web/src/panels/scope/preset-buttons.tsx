import { Button, Group } from "@mantine/core";
import { useMemo } from "react";
import { useBench } from "../../stream/bench-store";
import { presetsOn } from "./scope-presets";

/** The sets of signals that suit the bench, each a button. */
export function PresetButtons({ onChoose }: { onChoose(signals: string[]): void }) {
  const signals = useBench((s) => s.bench?.signals);
  const presets = useMemo(() => presetsOn(signals ?? []), [signals]);
  return (
    <Group gap={6} justify="center">
      {presets.map(({ title, signals }) => (
        <Button key={title} size="compact-xs" onClick={() => onChoose(signals)}>
          {title}
        </Button>
      ))}
    </Group>
  );
}
