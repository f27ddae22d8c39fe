import { Box, Button } from "@mantine/core";
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
  return (
    <section className={`view ${styles.sheet}`} aria-label="Lab sheet">
      <header className={styles.head}>
        <h2>{value.title}</h2>
        <p>
          <b data-testid="sheet-points">
            {formatShort(value.earned, "")} of {formatShort(value.points, "")} points
          </b>{" "}
          · {value.minutes} minutes
        </p>
        <div className={styles.buttons}>
          <Button onClick={onLeave}>All sheets</Button>
          <Button component="a" href={sheets.report(id)} target="_blank">
            Hand in
          </Button>
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
        </div>
        <Stale error={error} since={since} onRetry={again} />
      </header>
      {!value.bench && !value.done && (
        <div className={styles.gone} role="status">
          The bench of this sheet was closed. Your answers are kept.{" "}
          <Button variant="filled" onClick={() => void beginSheet(id).then(again, showError)}>
            Make it again
          </Button>
        </div>
      )}
      <SheetText text={value.intro} />
      <ol className={`column ${styles.sections}`}>
        {value.sections.map((section, i) => (
          // biome-ignore lint/suspicious/noArrayIndexKey: the sections of a sheet stay in their order
          <Section key={i} section={section} actions={actions} />
        ))}
      </ol>
      {value.done && (
        <Box component="p" fw={560}>
          All steps are done. Hand in gives you the sheet to print.
        </Box>
      )}
    </section>
  );
}

function Section({ section, actions }: { section: SheetSection; actions: StepActions }) {
  const { heading, state, text = "", step, after = "" } = section;
  const place = useRef<HTMLLIElement>(null);
  const was = useRef(state);
  useEffect(() => {
    // what opens comes into sight; what was open from the start stays where it is
    if (was.current === "closed" && state === "open") place.current?.scrollIntoView({ block: "nearest" });
    was.current = state;
  }, [state]);
  return (
    <li ref={place} data-state={state} aria-current={state === "open" ? "step" : undefined}>
      <h3>
        {heading}
        <span className="visually-hidden">
          {state === "done" ? ", done" : state === "closed" ? ". Complete the previous steps first" : ""}
        </span>
      </h3>
      <SheetText text={text} />
      {step && <StepView step={step} isOpen={state === "open"} actions={actions} />}
      <SheetText text={after} />
    </li>
  );
}

const openSection = (view: SheetView | undefined) => view?.sections.find(({ state }) => state === "open");

/** Whether the bench is looked at: then the page asks often. */
const isMeasuring = (view: SheetView | undefined) => ["hold", "blind"].includes(openSection(view)?.step?.kind ?? "");

/** Tell screen readers of a step that the bench has closed. */
function useSaid(view: SheetView | undefined): void {
  const done = view?.sections.filter(({ step, state }) => step && state === "done").length;
  const before = useRef(done);
  useEffect(() => {
    if (done !== undefined && before.current !== undefined && done > before.current)
      announce(`Step done. ${openSection(view)?.heading ?? "The sheet is finished"}`);
    before.current = done;
  }, [done, view]);
}
