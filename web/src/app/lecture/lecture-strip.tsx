import { ActionIcon, Button, Menu } from "@mantine/core";
import {
  IconChartBar,
  IconChevronLeft,
  IconChevronRight,
  IconExternalLink,
  IconList,
  IconNotes,
  IconNotesOff,
  IconX,
} from "@tabler/icons-react";
import { useEffect, useRef, useState } from "react";
import { useDock } from "../../bench/dock";
import { cueBefore, goTo, nextCue, resumeLecture, useLecture } from "../../bench/lecture";
import { setPage, useView } from "../../bench/view-store";
import { askCue } from "../../bench/vote";
import { useBench } from "../../stream/bench-store";
import { leave } from "./leave";
import styles from "./lecture.module.css";
import { LectureClock, Notes } from "./notes";
import { openPresenter, usePresenter } from "./presenter";
import { showCue } from "./show-cue";

/** The cues of a lecture along the bottom of the page. The notes have a window of their own; here they are shown on request. */
export function LectureStrip() {
  const lecture = useLecture((s) => s.lecture);
  const at = useLecture((s) => s.at);
  const busy = useLecture((s) => s.busy);
  const present = useView((s) => s.present);
  const page = useView((s) => s.page);
  const stage = useLecture((s) => s.stage);
  const tick = useLecture((s) => s.tick);
  const diagnoses = useBench(({ bench }) =>
    bench && bench.id === stage ? Object.keys(bench.diagnosers).length > 0 : undefined,
  );
  const dock = useDock((s) => s.dock);
  const place = useRef<HTMLElement>(null);
  const [notes, setNotes] = useState(false);
  usePresenter();
  useEffect(() => void resumeLecture(), []);
  useEffect(() => {
    if (lecture && at >= 0 && diagnoses !== undefined && dock && page === "bench")
      showCue(lecture.script, { at, tick }, diagnoses, present);
  }, [lecture, at, tick, diagnoses, dock, page, present]);
  // a button that has the keyboard would take the space bar for itself
  const shown = lecture?.script[at] !== undefined;
  useEffect(() => {
    if (shown) place.current?.focus();
  }, [shown]);
  const cue = lecture?.script[at];
  if (!lecture || !cue) return null;
  const count = `${at + 1} of ${lecture.script.length}`;
  if (present)
    return (
      <section className={styles.audience} aria-label="Lecture">
        <strong>{cue.title}</strong>
        <span>{count}</span>
      </section>
    );
  return (
    <section ref={place} className={`column ${styles.strip}`} aria-label="Lecture" aria-busy={busy} tabIndex={-1}>
      <div className={`row ${styles.bar}`}>
        <ActionIcon
          size={34}
          variant="default"
          aria-label="Cue before (Page Up, ←)"
          title="Cue before (Page Up, ←)"
          disabled={at === 0}
          onClick={cueBefore}
        >
          <IconChevronLeft size={19} />
        </ActionIcon>
        <Button
          variant="filled"
          size="compact-md"
          rightSection={<IconChevronRight size={17} />}
          disabled={at === lecture.script.length - 1}
          title="Next cue (Space, Page Down, →)"
          onClick={nextCue}
        >
          Next
        </Button>
        <Menu width={380} position="top-start">
          <Menu.Target>
            <ActionIcon size={34} aria-label="All cues" title="All cues">
              <IconList size={19} />
            </ActionIcon>
          </Menu.Target>
          <Menu.Dropdown>
            <Menu.Label>{lecture.title}</Menu.Label>
            {lecture.script.map(({ title }, i) => (
              <Menu.Item key={title} aria-current={i === at} fw={i === at ? 650 : undefined} onClick={() => goTo(i)}>
                {i + 1} {title}
              </Menu.Item>
            ))}
          </Menu.Dropdown>
        </Menu>
        <p className={styles.where}>
          <span>{count}</span>
          <strong>{cue.title}</strong>
        </p>
        {cue.vote && (
          <Button
            size="compact-md"
            variant="light"
            leftSection={<IconChartBar size={17} />}
            title="Open the vote of this cue (A)"
            onClick={() => void askCue()}
          >
            Ask by a vote
          </Button>
        )}
        <LectureClock />
        <span className="line">
          <Button
            size="compact-md"
            variant="light"
            leftSection={<IconExternalLink size={17} />}
            title="Notes of the speaker in a window of their own, for a second screen (I)"
            onClick={openPresenter}
          >
            Notes in a window
          </Button>
          <ActionIcon
            size={34}
            aria-label={notes ? "Hide the notes" : "Show the notes here, on the projector too"}
            title={notes ? "Hide the notes" : "Show the notes here, on the projector too"}
            aria-expanded={notes}
            onClick={() => setNotes(!notes)}
          >
            {notes ? <IconNotesOff size={19} /> : <IconNotes size={19} />}
          </ActionIcon>
          <Button size="compact-md" variant="subtle" leftSection={<IconX size={16} />} onClick={() => void leave()}>
            Leave
          </Button>
        </span>
      </div>
      {page !== "bench" && (
        <Button variant="light" onClick={() => setPage("bench")}>
          Back to the bench
        </Button>
      )}
      {notes && <Notes cue={cue} next={lecture.script[at + 1]?.title} />}
      <p className={styles.keys}>
        Space, → or a clicker: next cue; ← back. R runs and pauses. {cue.vote && "A opens the vote, X reveals it. "}W
        asks why. I opens the notes. P hides all buttons.
      </p>
    </section>
  );
}
