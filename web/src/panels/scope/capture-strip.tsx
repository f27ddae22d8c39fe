import { ActionIcon, Box, Group, Text } from "@mantine/core";
import { IconChevronLeft, IconChevronRight, IconChevronsRight } from "@tabler/icons-react";
import type { CaptureList, CaptureMark } from "../../stream/wire";
import { formatCount, formatMoment } from "../../ui/format";

interface CaptureStripProps {
  captures: CaptureList;
  standing: CaptureMark | undefined;
  dtMs: number;
  onStand(on: CaptureMark): void;
  onBrowse(by: number): void;
}

/** The captures of a trigger: previous, next, newest, and any of them under the hand. */
export function CaptureStrip({ captures: list, standing, dtMs, onStand, onBrowse }: CaptureStripProps) {
  const { captures } = list;
  const last = captures.length - 1;
  const found = captures.findIndex(({ tick }) => tick === standing?.tick);
  const at = standing ? found : last;
  const words = captureWords(list, standing, dtMs);
  const isNewest = standing !== undefined && at === last;
  const ways = [
    { name: "Previous", key: "Page up", Icon: IconChevronLeft, by: -1, isEnd: standing !== undefined && at === 0 },
    { name: "Next", key: "Page down", Icon: IconChevronRight, by: 1, isEnd: !standing || isNewest },
    { name: "Newest", key: "End", Icon: IconChevronsRight, by: Number.POSITIVE_INFINITY, isEnd: isNewest },
  ];
  return (
    <Group role="group" aria-label="Captures" gap={4} wrap="nowrap" flex="none" p="0 12px 4px" c="dimmed" fz="sm">
      {ways.map(({ name, key, Icon, by, isEnd }) => (
        <ActionIcon
          key={name}
          size={24}
          variant="default"
          aria-label={`${name} capture`}
          title={`${name} capture (${key})`}
          disabled={captures.length === 0 || isEnd}
          onClick={() => onBrowse(by)}
        >
          <Icon size={15} />
        </ActionIcon>
      ))}
      {captures.length > 1 && (
        <Box
          component="input"
          flex="1 1 60px"
          miw={60}
          maw={220}
          h={24}
          m="0 4px"
          style={{ accentColor: standing ? "var(--accent)" : "var(--muted)" }}
          type="range"
          aria-label="Capture"
          aria-valuetext={words}
          min={0}
          max={last}
          step={1}
          value={Math.max(0, at)}
          onChange={(event) => onStand(captures[Number(event.currentTarget.value)])}
        />
      )}
      <Text component="output" inherit truncate {...(standing && STANDING)} title={list.is_short ? SHORT : KEPT}>
        {words}
      </Text>
    </Group>
  );
}

const STANDING = { c: "var(--accent)", fw: 560 };
const KEPT = "The last captures keep their full rate, even after the history has passed them. L returns to live.";
const SHORT = "The memory of the bench has no room for more captures of this window: the oldest go first.";

/** The capture that the scope shows, or the number of captures. */
export function captureWords(
  { captures, most, is_short }: CaptureList,
  standing: CaptureMark | undefined,
  dtMs: number,
) {
  if (standing) {
    const at = captures.findIndex(({ tick }) => tick === standing.tick);
    const moment = formatMoment(standing.trigger_tick * dtMs);
    return at < 0 ? `capture at ${moment}, no longer kept` : `capture ${at + 1} of ${captures.length} at ${moment}`;
  }
  if (captures.length === 0) return is_short ? "no room to keep captures of this window" : "no captures yet";
  const kept = `${formatCount(captures.length, "capture")} kept`;
  return is_short && captures.length < most ? `${kept}, all that memory has room for` : kept;
}
