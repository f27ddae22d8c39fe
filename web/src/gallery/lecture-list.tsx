import { Button } from "@mantine/core";
import { IconPlayerPlay } from "@tabler/icons-react";
import { lectures } from "../api/lectures";
import { useAsked } from "../api/queries";
import { notesOf, startLecture } from "../bench/lecture";
import { formatCount, formatShort } from "../ui/format";
import styles from "./gallery.module.css";

/** The lectures: scripts of some minutes that go from experiment to experiment, with notes for the speaker. */
export function LectureList() {
  const { answer: value } = useAsked(["lectures"], lectures.all);
  if (!value?.length) return null;
  return (
    <details className={styles.lectures}>
      <summary>
        {formatCount(value.length, "lecture")} with notes for the speaker, chapters {value[0].chapter} to{" "}
        {value.at(-1)?.chapter}
      </summary>
      <ul aria-label="Lectures">
        {value.map(({ id, title, summary, minutes, cues }) => (
          <li key={id}>
            <div>
              <h2>{title}</h2>
              <p>{summary}</p>
            </div>
            <Button
              size="compact-sm"
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
          </li>
        ))}
      </ul>
    </details>
  );
}
