import { Button, Group, Popover, Stack, Text } from "@mantine/core";
import { useState } from "react";
import { send } from "../../bench/send";
import {
  againstRealTime,
  formatTimeScale,
  PRESETS,
  presetLabel,
  scaleMarks,
  sliderToTimeScale,
  timeScaleToSlider,
} from "../../bench/time-scale";
import { useBench } from "../../stream/bench-store";
import { useBoardState } from "../../stream/freshness";
import { Slider } from "../../ui/slider";
import styles from "./header.module.css";

const set = (value: number | null) => send({ kind: "time_scale", value }, `Time scale ${formatTimeScale(value)}`);

const FAST = { quiet_lead: "quiet lead, fast", skip: "skips, fast" };

/** The speed of device time, and the achieved speed below it; a menu has a slider and presets. */
export function TimeScaleControl() {
  const target = useBench((s) => s.bench?.time_scale ?? null);
  const achieved = useBench((s) => s.bench?.achieved_scale ?? 0);
  const state = useBoardState();
  const unknown = state === undefined;
  const capped = useBench((s) => s.bench?.capped ?? false) && !unknown;
  const running = state === "running";
  const fast = useBench((s) => s.bench?.fast_forward);
  const [draft, setDraft] = useState<number | undefined>(undefined);
  const wanted = draft === undefined ? target : sliderToTimeScale(draft);
  const shown = draft ?? timeScaleToSlider(target);

  return (
    <fieldset className="line" style={{ gap: 0 }} aria-label="Time scale" disabled={unknown}>
      <Popover width={400} position="bottom">
        <Popover.Target>
          <button type="button" className={styles.target} title={`${againstRealTime(target)}: change it`}>
            <span>{target === null ? "max" : formatTimeScale(target)}</span>
            <small data-capped={capped}>
              {capped && <b>CAPPED </b>}
              {unknown
                ? "not connected"
                : running && fast
                  ? FAST[fast]
                  : running
                    ? `runs ${formatTimeScale(achieved)}`
                    : "stands still"}
            </small>
          </button>
        </Popover.Target>
        <Popover.Dropdown>
          <Stack gap="sm">
            <Text size="sm">
              Device time per second of yours: <b>{formatTimeScale(wanted)}</b>, {againstRealTime(wanted)}
            </Text>
            <Slider
              min={0}
              max={1}
              step={0.001}
              value={shown}
              label={null}
              thumbLabel="Time scale"
              onChange={setDraft}
              onChangeEnd={(position) => {
                setDraft(undefined);
                set(sliderToTimeScale(position));
              }}
              marks={scaleMarks()}
              mb="lg"
              mx="xl"
            />
            <Group grow preventGrowOverflow={false} wrap="nowrap" gap="sm">
              {PRESETS.map((scale) => (
                <Button
                  key={presetLabel(scale)}
                  size="xs"
                  variant={target === scale ? "filled" : "default"}
                  onClick={() => set(scale)}
                >
                  {presetLabel(scale)}
                </Button>
              ))}
            </Group>
          </Stack>
        </Popover.Dropdown>
      </Popover>
    </fieldset>
  );
}
