import { Button, Group, NativeSelect, NumberInput, Popover, SegmentedControl, Stack, Text } from "@mantine/core";
import { useBench } from "../../stream/bench-store";
import type { Trigger } from "../../stream/wire";
import { formatShort } from "../../ui/format";
import { unitText } from "../../ui/unit-scale";
import { signalGroups } from "../condition/condition";

export type TriggerState = "none" | "waiting" | "triggered";

const SIGNS: Record<Trigger["edge"], string> = { rising: "↗", falling: "↘", either: "↕", enters: "⇥", leaves: "⇤" };
const isOfWindow = (edge: Trigger["edge"]) => edge === "enters" || edge === "leaves";

interface TriggerMenuProps {
  trigger: Trigger;
  state: TriggerState;
  onChange(trigger: Trigger): void;
  /** Arm a single sweep once more. */
  onRearm(): void;
}

/** The trigger of a scope: a signal, a level or a window, and a direction; the server finds it at full rate. */
export function TriggerMenu({ trigger, state, onChange, onRearm }: TriggerMenuProps) {
  const signals = useBench((s) => s.bench?.signals) ?? [];
  const signalUnit = signals.find((s) => s.name === trigger.signal)?.unit ?? "";
  const unit = unitText(signalUnit);
  const set = (part: Partial<Trigger>) => onChange({ ...trigger, ...part });
  const isWindow = isOfWindow(trigger.edge);
  const width = (trigger.upper ?? trigger.level) - trigger.level;
  const setLevel = (level: number) => set({ level, upper: trigger.upper === null ? null : level + width });
  const setEdge = (edge: Trigger["edge"]) =>
    set({ edge, upper: isOfWindow(edge) ? (trigger.upper ?? trigger.level + 1) : null });
  return (
    <Popover position="bottom-end" width={280}>
      <Popover.Target>
        <Button size="compact-xs" h={26}>
          {state === "triggered" ? "● " : state === "waiting" ? "○ waiting " : ""}
          {SIGNS[trigger.edge]} {formatShort(trigger.level, signalUnit)}
          {isWindow && ` to ${formatShort(trigger.upper ?? trigger.level, signalUnit)}`}
        </Button>
      </Popover.Target>
      <Popover.Dropdown>
        <Stack gap="sm">
          <NativeSelect
            label="Signal"
            value={trigger.signal}
            data={signalGroups(signals)}
            onChange={(e) => set({ signal: e.currentTarget.value })}
          />
          <NativeSelect
            label="When it"
            value={trigger.edge}
            data={[
              { value: "rising", label: "↗ rises through a level" },
              { value: "falling", label: "↘ falls through a level" },
              { value: "either", label: "↕ rises or falls through a level" },
              { value: "enters", label: "⇥ enters a window" },
              { value: "leaves", label: "⇤ leaves a window" },
            ]}
            onChange={(e) => setEdge(e.currentTarget.value as Trigger["edge"])}
          />
          <Group grow gap="sm">
            <NumberInput
              label={isWindow ? "From" : "Level"}
              max={isWindow ? (trigger.upper ?? undefined) : undefined}
              suffix={unit ? ` ${unit}` : ""}
              value={trigger.level}
              step={0.1}
              onChange={(v) => typeof v === "number" && setLevel(v)}
            />
            {isWindow && (
              <NumberInput
                label="To"
                suffix={unit ? ` ${unit}` : ""}
                value={trigger.upper ?? trigger.level}
                step={0.1}
                onChange={(v) => typeof v === "number" && v > trigger.level && set({ upper: v })}
              />
            )}
            <NumberInput
              label="Hysteresis"
              suffix={unit ? ` ${unit}` : ""}
              min={0}
              step={0.1}
              value={trigger.hysteresis}
              onChange={(v) => typeof v === "number" && set({ hysteresis: v })}
            />
          </Group>
          <NumberInput
            label="Shown before the edge"
            suffix=" %"
            min={0}
            max={100}
            step={5}
            allowDecimal={false}
            value={Math.round(trigger.position * 100)}
            onChange={(v) => typeof v === "number" && set({ position: v / 100 })}
          />
          <SegmentedControl
            fullWidth
            aria-label="Sweep"
            value={trigger.sweep}
            data={["auto", "normal", "single"]}
            onChange={(sweep) => set({ sweep: sweep as Trigger["sweep"] })}
          />
          <Text size="xs" c="dimmed">
            {SWEEPS[trigger.sweep]}
          </Text>
          {trigger.sweep === "single" && (
            <Button size="xs" variant="light" onClick={onRearm}>
              Arm again
            </Button>
          )}
        </Stack>
      </Popover.Dropdown>
    </Popover>
  );
}

const SWEEPS: Record<Trigger["sweep"], string> = {
  auto: "Auto: without an edge the picture rolls on.",
  normal: "Normal: without an edge the last picture stays.",
  single: "Single: the first edge is kept until armed again.",
};
