import { Box, Button, Group } from "@mantine/core";
import { api } from "../api/api";
import { useAnswer } from "../api/queries";
import { formatCount } from "../ui/format";

const AGAIN_MS = 4000;
const LINE = { borderTop: "1px solid var(--line)" };

interface FullServerProps {
  onJoin(bench: string): void;
  onRetry(): void;
}

/** The server has no room for another bench: the open benches, the next to close, and the choices of the user. */
export function FullServer({ onJoin, onRetry }: FullServerProps) {
  const { value: benches = [] } = useAnswer(["benches"], api.benches, () => AGAIN_MS);
  const leaving = benches.flatMap((b) => b.let_go_in_s ?? []);
  return (
    <Box component="main" flex={1} w="min(100%, 620px)" m="0 auto" p="32px 16px" style={{ overflowY: "auto" }}>
      <Box component="h1" fz="xl">
        This server has no free bench
      </Box>
      <Box component="p" maw="60ch" c="dimmed">
        It has {benches.length === 1 ? "one bench" : `${benches.length} benches`}, which is its limit.{" "}
        {leaving.length > 0
          ? `Nobody watches ${leaving.length} of them; the next one is let go in ${formatCount(Math.ceil(Math.min(...leaving) / 60), "minute")}, unless somebody comes back to it.`
          : "All benches are watched or busy. Wait until one is closed, or ask the administrator of the server."}{" "}
        Meanwhile you can join one and watch.
      </Box>
      <Button variant="filled" size="sm" onClick={onRetry}>
        Try again
      </Button>
      <Box component="ul" mt={24} aria-label="Benches that run">
        {benches.map((b) => (
          <Group component="li" key={b.id} justify="space-between" wrap="nowrap" py={8} style={LINE}>
            <div>
              <b>{b.title}</b>
              <Box component="small" display="block">
                {b.state} · {b.watchers} watching · since{" "}
                {new Date(b.created).toLocaleTimeString([], { timeStyle: "short" })}
              </Box>
            </div>
            <Button size="xs" flex="none" onClick={() => onJoin(b.id)} aria-label={`Join ${b.title}`}>
              Join
            </Button>
          </Group>
        ))}
      </Box>
    </Box>
  );
}
