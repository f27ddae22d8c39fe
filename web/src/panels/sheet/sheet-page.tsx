import { Box, Button, Group } from "@mantine/core";
import { useEffect, useRef } from "react";
import { useMay } from "../../api/me";
import { queryClient, useAnswer } from "../../api/queries";
import { sheets } from "../../api/sheets";
import type { SheetSection, SheetView } from "../../api/types";
import { announce } from "../../bench/announce";
import { showError } from "../../bench/send";
import { EmptyState } from "../../ui/empty-state";
import { formatShort } from "../../ui/format";
import { Stale } from "../../ui/stale";
import { beginSheet, hideInStep } from "./begin";
import { HandedIn } from "./handed-in";
import styles from "./sheet.module.css";
import { SheetText } from "./sheet-text";
import { type StepActions, StepView } from "./step-view";

const LIVE_MS = 400;
const CALM_MS = 3000;

/** A sheet with its steps. */
export function SheetPage({ id, onLeave }: { id: string; onLeave(): void }) {
  const teaches = useMay("teach");
  const { value, error, since, again } = useAnswer(
    ["sheet", id],
    () => sheets.get(id),
    (view) => (isMeasuring(view) ? LIVE_MS : CALM_MS),
  );
  useSaid(value);
  if (!value) return <EmptyState title="Lab sheet">Loading the sheet…</EmptyState>;
  const take = async (asked: Promise<SheetView>) => {
    queryClient.setQueryData(["sheet", id], await asked);
  };
  const actions: StepActions = {
    answer: (step, answer) => take(sheets.answer(id, step, answer)),
    hide: (step) => void hideInStep(id, step).then(again, showError),
    hint: (step) => void take(sheets.hint(id, step)).catch(showError),
    close: (step) => void take(sheets.close(id, step)).catch(showError),
  };
  const startOver = async () => {
    if (!window.confirm("Delete all answers of this sheet and start over?")) return;
    await sheets.startOver(id);
    await beginSheet(id);
    again();
  };
  const handIn = (
    <Button component="a" href={sheets.report(id)} target="_blank">
      Hand in
    </Button>
  );
  return (
    <section className={`view ${styles.sheet}`} aria-label="Lab sheet">
      <header>
        <Box component="h2" fz="lg" lh={1.3}>
          {value.title}
        </Box>
        <Box component="p" m="2px 0 8px" c="dimmed">
          <Box component="b" c="var(--text)" fw={600} data-testid="sheet-points">
            {formatShort(value.earned, "")} of {formatShort(value.points, "")} points
          </Box>{" "}
          · {value.minutes} minutes
        </Box>
        <Group gap={8}>
          <Button onClick={onLeave}>All sheets</Button>
          {handIn}
          {value.begun && (
            <HandedIn
              ids={value.recordings ?? []}
              onAdd={(recording) => void take(sheets.keep(id, recording)).catch(showError)}
            />
          )}
          {teaches && (
            <Button variant="subtle" onClick={() => void startOver().catch(showError)}>
              Start over…
            </Button>
          )}
        </Group>
        <Stale error={error} since={since} onRetry={again} />
      </header>
      {!value.bench && !value.done && (
        <Box p="8px 12px" style={{ borderLeft: "3px solid var(--paused)" }} role="status">
          The bench of this sheet was closed. Your answers are kept.{" "}
          <Button variant="filled" onClick={() => void beginSheet(id).then(again, showError)}>
            Make it again
          </Button>
        </Box>
      )}
      <SheetText text={value.intro} />
      <Box component="ol" className="column" style={{ gap: 16 }}>
        {value.sections.map((section, i) => (
          // biome-ignore lint/suspicious/noArrayIndexKey: the sections of a sheet stay in their order
          <Section key={i} section={section} actions={actions} />
        ))}
      </Box>
      {value.done && (
        <Group gap={8}>
          {handIn}
          <Box component="p" fw={560}>
            All steps are done. Hand in gives you the sheet to print.
          </Box>
        </Group>
      )}
    </section>
  );
}

function Section({ section, actions }: { section: SheetSection; actions: StepActions }) {
  const { heading, state, text = "", step, after = "" } = section;
  const place = useRef<HTMLLIElement>(null);
  const was = useRef(state);
  useEffect(() => {
    // a section that opens comes into sight, the last one without a step too; others stay in their place
    if (was.current === "closed" && state !== "closed") place.current?.scrollIntoView({ block: "nearest" });
    was.current = state;
  }, [state]);
  return (
    <li
      ref={place}
      data-state={state}
      style={{ scrollMargin: "12px 0 72px" }}
      aria-current={state === "open" ? "step" : undefined}
    >
      <Box component="h3" mb={4} {...(state === "closed" && { c: "dimmed", fw: 500 })}>
        {heading}
        <span className="visually-hidden">
          {state === "done" ? ", done" : state === "closed" ? ". Complete the previous steps first" : ""}
        </span>
      </Box>
      <SheetText text={text} />
      {step && <StepView step={step} isOpen={state === "open"} actions={actions} />}
      <SheetText text={after} />
    </li>
  );
}

const openSection = (view: SheetView | undefined) => view?.sections.find(({ state }) => state === "open");

/** Whether the server watches the bench: then the page asks often. */
const isMeasuring = (view: SheetView | undefined) => ["hold", "blind"].includes(openSection(view)?.step?.kind ?? "");

/** Tell screen readers about a step that the bench has closed. */
function useSaid(view: SheetView | undefined): void {
  const done = view?.sections.filter(({ step, state }) => step && state === "done").length;
  const before = useRef(done);
  useEffect(() => {
    if (done !== undefined && before.current !== undefined && done > before.current)
      announce(`Step done. ${openSection(view)?.heading ?? "The sheet is finished"}`);
    before.current = done;
  }, [done, view]);
}
