import { Box, Group } from "@mantine/core";
import { classes } from "../api/classes";
import { useList } from "../api/queries";
import { EmptyState } from "../ui/empty-state";
import { formatTick } from "../ui/format";
import { Sheet } from "../ui/sheet";
import { ShowOlder } from "../ui/show-older";
import { Stale } from "../ui/stale";

const EVERY_MS = 3000;
const LINE = { borderBottom: "1px solid var(--line)" };

interface DoneSheetProps {
  opened: boolean;
  group: string;
  /** Names of the students by their benches of now. */
  owners: ReadonlyMap<string, string>;
  onClose(): void;
}

/** Who did what in a class, and when; newest first. */
export function DoneSheet({ opened, onClose, ...rest }: DoneSheetProps) {
  return (
    <Sheet opened={opened} title="Activity" size={480} onClose={onClose}>
      {opened && <Done {...rest} />}
    </Sheet>
  );
}

function Done({ group, owners }: Pick<DoneSheetProps, "group" | "owners">) {
  const { value, error, since, again, more } = useList(
    ["audit", group],
    (most) => classes.audit(group, most),
    () => EVERY_MS,
  );
  return (
    <>
      <Stale error={error} since={since} onRetry={again} />
      {value?.length === 0 && (
        <EmptyState title="Nothing yet">
          This list will show new students and their actions on their benches.
        </EmptyState>
      )}
      <ol aria-label="Activity, newest first">
        {value?.map(({ at, actor, text, tick, bench_id }) => {
          const owner = owners.get(bench_id ?? "");
          return (
            <Group
              component="li"
              key={`${at} ${actor} ${text}`}
              gap={12}
              py={6}
              fz="sm"
              wrap="nowrap"
              align="start"
              style={LINE}
            >
              <Box component="time" flex="none" miw="9ch" c="dimmed" dateTime={at}>
                {new Date(at).toLocaleTimeString()}
              </Box>
              <p style={{ overflowWrap: "anywhere" }}>
                <b>{actor}</b>
                {owner && owner !== actor && ` on the bench of ${owner}`}: {text}
                {tick !== null && <small> {formatTick(tick)}</small>}
              </p>
            </Group>
          );
        })}
      </ol>
      <ShowOlder more={more} />
    </>
  );
}
