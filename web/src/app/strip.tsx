import { Box, Button, Popover } from "@mantine/core";
import { IconChevronUp } from "@tabler/icons-react";
import { useState } from "react";
import { useMay, useServed } from "../api/me";
import { useLecture } from "../bench/lecture";
import { toggleNarrator, useNarrator } from "../bench/narrator";
import { useSteps } from "../bench/steps";
import { useView } from "../bench/view-store";
import { NarratorPanel } from "../panels/narrator/narrator-panel";
import { useBench } from "../stream/bench-store";
import { Caption } from "./caption";
import { LectureStrip } from "./lecture/lecture-strip";
import rest from "./rest.module.css";
import { Findings, StepBar, useScored } from "./step-bar";
import styles from "./strip.module.css";
import { TimeBar } from "./time-bar";
import { HintList, TryThis } from "./try-this";
import { type TickedHints, useHints } from "./use-hints";

/**
 * The row under the panels: the next hint or step or the cue of a lecture, the newest sentence of the narrator, and the timeline. The rest opens
 * over the panels. An audience sees the sentence alone.
 */
export function Strip() {
  const present = useView((s) => s.present);
  // the next step of a lecture is asked before it is shown
  const lectures = useLecture((s) => s.lecture !== undefined);
  const hasSteps = useSteps().length > 1 && !lectures;
  const drives = useMay("drive");
  const noted = useBench((s) => s.blind || Boolean(s.bench?.opened?.note));
  const ticked = useHints();
  const tips = hasSteps || lectures || noted || !drives ? undefined : ticked;
  const narrates = useNarrator((s) => s.on);
  if (present && !narrates && !lectures) return null;
  return (
    <footer className={styles.strip}>
      <div className={`line ${styles.row}`}>
        <LectureStrip />
        {!present && hasSteps && <StepBar />}
        {!present && tips && <TryThis tips={tips} />}
        <Caption intro={tips?.intro} />
        {!present && <TimeBar />}
        {!present && <Rest tips={tips} hasSteps={hasSteps} />}
      </div>
    </footer>
  );
}

/** The rest of the strip: all hints, the steps with their findings, all sentences. */
function Rest({ tips, hasSteps }: { tips: TickedHints | undefined; hasSteps: boolean }) {
  const [opened, setOpened] = useState(false);
  const narrates = useNarrator((s) => s.on);
  const said = useBench((s) => s.narration.sentences.length > 0);
  const scored = useScored();
  const served = useServed();
  if (!served && !hasSteps && !tips) return null;
  const label = hasSteps ? (scored.length > 0 ? "Findings" : "All steps") : tips ? "All hints" : "All sentences";
  return (
    <Popover opened={opened} onChange={setOpened} width="min(640px, 94vw)" position="top-end" shadow="md">
      <Popover.Target>
        <Button
          px={6}
          rightSection={<IconChevronUp size={16} />}
          style={{ flex: "none" }}
          onClick={() => setOpened(!opened)}
        >
          {label}
        </Button>
      </Popover.Target>
      <Popover.Dropdown
        className={`column ${rest.rest}`}
        onClick={({ target }) => (target as Element).closest("button:not([aria-haspopup])") && setOpened(false)}
      >
        {tips && <HintList tips={tips} />}
        {hasSteps && <Findings scored={scored} />}
        {served && narrates && said && (
          <Box flex="none" h={200}>
            <NarratorPanel />
          </Box>
        )}
        {served && (
          <Button variant="subtle" style={{ alignSelf: "start" }} onClick={toggleNarrator}>
            {narrates ? "Narrator off (Q)" : "Narrator on (Q)"}
          </Button>
        )}
      </Popover.Dropdown>
    </Popover>
  );
}
