import { ActionIcon, Button, Text } from "@mantine/core";
import { IconX } from "@tabler/icons-react";
import { Fragment, type RefObject, useEffect, useLayoutEffect, useRef } from "react";
import { usePanelVisible } from "../../api/panel-visible";
import { useCatalog } from "../../api/use-catalog";
import { type Change, comparisons, dismissChange } from "../../bench/change";
import { showing } from "../../bench/send";
import { fileStem } from "../../picture/picture";
import { useBench } from "../../stream/bench-store";
import { formatMoment } from "../../ui/format";
import { faded } from "../../ui/palette";
import { pngOf, saveFile } from "../../ui/save-file";
import { SignalName, TraceSwatch } from "../../ui/trace-swatch";
import { useScheme } from "../../ui/use-canvas";
import { changeSlide } from "./before-after-slide";
import { changeWords } from "./change-words";
import { type Compared, comparedOf } from "./compared";
import type { PlotTrace } from "./paint-scope";
import styles from "./scope.module.css";
import type { ScopePlot } from "./scope-plot";
import type { Figures } from "./use-figures";

const HIDDEN = "Before and after are hidden while a fault is hidden.";
const SLIDE_RATIO = 1.5;

interface BeforeAfterProps {
  change: Change;
  isHidden: boolean;
  figures: Figures | undefined;
  traces: PlotTrace[];
  plot: RefObject<ScopePlot | undefined>;
}

/** The last change in words, with the figures of the scope before and after it. */
export function BeforeAfter({ change, isHidden, figures, traces, plot }: BeforeAfterProps) {
  const dtMs = useBench((s) => s.bench?.dt_ms ?? 1);
  useCatalog(); // the words come from its cards
  const box = useRef<HTMLElement>(null);
  const compared = figures && !isHidden ? comparedOf(traces, figures, change.tick) : [];
  const words = changeWords(change, useBench.getState().bench);
  const canSlide = compared.length > 0;
  const slide = showing(async () => {
    const shown = plot.current?.picture();
    const { bench } = useBench.getState();
    if (!shown || !bench) return;
    const svg = changeSlide(words, change.tick, compared, shown, bench);
    saveFile(`${fileStem(`${bench.scenario_id || "bench"}-${words}`)}-slide.png`, await pngOf(svg, SLIDE_RATIO));
  });
  useSlideKey(canSlide, box, compared[0]?.strength ?? 0, slide);
  return (
    <section ref={box} className={styles.change} aria-label="Before and after">
      <Text inherit truncate title={words}>
        <b>{words}</b> <span className={styles.wide}>at {formatMoment(change.tick * dtMs)}</span>
      </Text>
      {isHidden ? <p className={styles.figures}>{HIDDEN}</p> : <ComparedList compared={compared} />}
      {canSlide && (
        <Button size="compact-xs" title="This picture as one slide, 16:9 (S)" onClick={slide}>
          Slide
        </Button>
      )}
      <ActionIcon size={22} aria-label="Dismiss" title="Dismiss the comparison" onClick={dismissChange}>
        <IconX size={14} />
      </ActionIcon>
    </section>
  );
}

const MEANINGS = {
  RMS: "RMS over whole periods of the drive",
  noise: "RMS of what remains without the mean, the tone of the drive and its harmonics",
};

/** Figures before in the colour of the ghost, figures after in the colour of the trace, as far as a row has room. */
function ComparedList({ compared }: { compared: Compared[] }) {
  const scheme = useScheme();
  const list = useFirstRow<HTMLUListElement>();
  const told = compared.filter(({ ratio }, i) => i === 0 || ratio);
  return (
    <ul ref={list} className={styles.figures}>
      {told.map(({ trace, measure, before, after, ratio, isSettled }) => (
        <Fragment key={trace.name + measure}>
          <li>
            <SignalName name={trace.name} /> {measure === "noise" && measure}{" "}
            <b>{[ratio, !isSettled && "still settling"].filter(Boolean).join(", ")}</b>
          </li>
          <li title={MEANINGS[measure]}>
            <TraceSwatch colour={faded(trace.colour, scheme)} dash={trace.dash} />
            <span className={styles.wide}>before</span> {before} →{" "}
            <TraceSwatch colour={trace.colour} dash={trace.dash} />
            <span className={styles.wide}>now</span> {after} {measure}
          </li>
        </Fragment>
      ))}
    </ul>
  );
}

/** Let the page's key make the slide of this comparison, if it is the strongest or under the pointer. */
function useSlideKey(isOn: boolean, box: RefObject<HTMLElement | null>, strength: number, make: () => void): void {
  const visible = usePanelVisible();
  const latest = useRef({ strength, make });
  latest.current = { strength, make };
  useEffect(() => {
    if (!isOn || !visible) return;
    const one = {
      strength: () =>
        box.current?.parentElement?.matches(":hover, :focus-within")
          ? Number.POSITIVE_INFINITY
          : latest.current.strength,
      make: () => latest.current.make(),
    };
    comparisons.add(one);
    return () => void comparisons.delete(one);
  }, [isOn, visible, box]);
}

/** A list that wraps: entries without room in its first row are not shown. */
function useFirstRow<T extends HTMLElement>(): RefObject<T | null> {
  const list = useRef<T>(null);
  // entries have other widths after each render
  useLayoutEffect(() => {
    const box = list.current;
    if (!box) return;
    const entries = Array.from(box.children) as HTMLElement[];
    const hideRest = () => {
      for (const entry of entries)
        entry.style.visibility = entry.offsetTop > entries[0].offsetTop ? "hidden" : "visible";
    };
    hideRest();
    const observer = new ResizeObserver(hideRest);
    observer.observe(box);
    return () => observer.disconnect();
  });
  return list;
}
