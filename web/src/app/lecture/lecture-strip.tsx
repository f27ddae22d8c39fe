import { ActionIcon, Button, Group, Menu, Popover } from "@mantine/core";
import { IconChevronLeft, IconChevronRight, IconExternalLink, IconList, IconNotes, IconX } from "@tabler/icons-react";
import { useEffect, useRef } from "react";
import { useDock } from "../../bench/dock";
import { cueBefore, goTo, leaveLecture, nextCue, useLecture } from "../../bench/lecture";
import { setPage, useView } from "../../bench/view-store";
import { askCue } from "../../bench/vote";
import { useBench } from "../../stream/bench-store";
import { setLayout } from "../layouts";
import styles from "./lecture.module.css";
import { LectureClock, Notes } from "./notes";
import { openPresenter, usePresenter } from "./presenter";
import { showCue } from "./show-cue";

/** The bench and the layout are then as before the lecture. */
const leave = () => leaveLecture().then((before) => before && setLayout(before.layout));

/** The cues of a lecture in the strip under the panels. The notes have a window of their own; here they open on request. */
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
  usePresenter();
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
      <Group component="section" flex="none" gap={12} wrap="nowrap" align="baseline" fz="md" aria-label="Lecture">
        <strong>{cue.title}</strong>
        <span style={{ color: "var(--muted)" }}>{count}</span>
      </Group>
    );
  return (
    <section ref={place} className={styles.lecture} aria-label="Lecture" aria-busy={busy} tabIndex={-1}>
      <ActionIcon
        size={28}
        variant="default"
        aria-label="Cue before (Page Up, ←)"
        title="Cue before (Page Up, ←)"
        disabled={at === 0}
        onClick={cueBefore}
      >
        <IconChevronLeft size={17} />
      </ActionIcon>
      <Button
        variant="filled"
        rightSection={<IconChevronRight size={15} />}
        disabled={at === lecture.script.length - 1}
        title="Next cue (Space, Page Down, →)"
        onClick={nextCue}
      >
        Next
      </Button>
      <p className={styles.where} title={cue.title}>
        <span className="note">{count}</span>
        <strong className="cut">{cue.title}</strong>
      </p>
      {cue.vote && (
        <Button variant="light" title="Open the vote of this cue (A)" onClick={() => void askCue()}>
          Ask by a vote
        </Button>
      )}
      {page !== "bench" && (
        <Button variant="light" onClick={() => setPage("bench")}>
          Back to the bench
        </Button>
      )}
      <Menu width={380} position="top-start" shadow="md">
        <Menu.Target>
          <ActionIcon size={28} aria-label="All cues" title="All cues">
            <IconList size={17} />
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
      <Popover width="min(720px, 94vw)" position="top-start" shadow="md">
        <Popover.Target>
          <ActionIcon size={28} aria-label="Notes" title="Notes of the speaker, on the projector too">
            <IconNotes size={17} />
          </ActionIcon>
        </Popover.Target>
        <Popover.Dropdown>
          <Button
            variant="light"
            leftSection={<IconExternalLink size={15} />}
            title="Notes of the speaker in a window of their own, for a second screen (I)"
            onClick={openPresenter}
          >
            Notes in a window
          </Button>
          <Notes cue={cue} next={lecture.script[at + 1]?.title} />
          <LectureClock />
        </Popover.Dropdown>
      </Popover>
      <ActionIcon size={28} aria-label="Leave the lecture" title="Leave the lecture" onClick={() => void leave()}>
        <IconX size={17} />
      </ActionIcon>
    </section>
  );
}
