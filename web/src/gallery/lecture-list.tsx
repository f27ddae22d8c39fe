import { Box, Button, Group, Stack } from "@mantine/core";
import { IconPlayerPlay } from "@tabler/icons-react";
import { lectures } from "../api/lectures";
import { useAsked } from "../api/queries";
import { notesOf, startLecture } from "../bench/lecture";
import { formatCount, formatShort } from "../ui/format";

/** The lectures: scripts of some minutes that go from experiment to experiment, with notes for the speaker. */
export function LectureList() {
  const { answer: value } = useAsked(["lectures"], lectures.all);
  if (!value?.length) return null;
  return (
    <Box component="details" className="card" flex="none" mah="45vh" p="8px 12px" style={{ overflowY: "auto" }}>
      <summary>
        {formatCount(value.length, "lecture")} with notes for the speaker, chapters {value[0].chapter} to{" "}
        {value.at(-1)?.chapter}
      </summary>
      <Stack component="ul" gap={10} m="10px 0 4px" aria-label="Lectures">
        {value.map(({ id, title, summary, minutes, cues }) => (
          <Group component="li" key={id} gap="4px 12px">
            <Box flex="1 1 300px">
              <h2>{title}</h2>
              <p className="note">{summary}</p>
            </Box>
            <Button
              variant="filled"
              leftSection={<IconPlayerPlay size={15} />}
              aria-label={`Start ${title}`}
              onClick={() => void startLecture(id)}
            >
              Start, {formatShort(minutes, "min")}
            </Button>
            <Button
              component="a"
              href={notesOf(id)}
              size="compact-sm"
              variant="subtle"
              aria-label={`Notes of ${title}`}
            >
              Notes
            </Button>
            <small>{formatCount(cues, "cue")}</small>
          </Group>
        ))}
      </Stack>
    </Box>
  );
}
