import { Button } from "@mantine/core";
import { useMemo, useRef } from "react";
import { useMay } from "../../api/me";
import { usePanelVisible } from "../../api/panel-visible";
import { openVariant } from "../../bench/open-bench";
import { useBusy } from "../../bench/use-busy";
import { useBench } from "../../stream/bench-store";
import { middles } from "../../stream/panel-frame";
import { useFeed } from "../../stream/use-feed";
import { formatShort, formatSi } from "../../ui/format";
import { useRestingTick } from "../../ui/hover";
import styles from "./adaptation.module.css";

const EVERY_MS = 150;
const USUAL_LEAST = 1e-5;

/** How much the input tells, now or at the tick a pointer rests at: the smallest eigenvalue of the windowed Gram matrix of the regressor, against the least that will do. */
export function ExcitationMeter() {
  const signals = useBench((s) => s.bench?.signals);
  const parameters = useBench((s) => s.bench?.parameters);
  const [busy, during] = useBusy();
  const teaches = useMay("teach");
  const source = signals?.find((s) => s.name.endsWith(".excitation_relative"))?.name.split(".")[0];
  const section = (parameters?.identifiers as Record<string, { least_excitation?: number }> | undefined)?.[
    source ?? ""
  ];
  const least = section?.least_excitation ?? USUAL_LEAST;
  const fill = useRef<HTMLDivElement>(null);
  const words = useRef<HTMLElement>(null);
  const rested = useRestingTick(usePanelVisible());
  const subscription = useMemo(() => {
    if (!source) return undefined;
    const signals = [`${source}.excitation_relative`, `${source}.excitation`, `${source}.identifiable`];
    return rested === undefined
      ? { mode: "roll" as const, signals, window_ms: 0.5, width: 2 }
      : { mode: "frozen" as const, signals, start_tick: rested, end_tick: rested + 1, width: 1 };
  }, [source, rested]);
  useFeed(
    subscription,
    (frame) => {
      if (!fill.current || !words.current) return;
      const [relative, , identifiable] = frame.frozen ? [0, 1, 2].map((i) => middles(frame, i)[0]) : frame.latest;
      fill.current.style.setProperty("--share", `${100 * meterShare(relative)}%`);
      fill.current.dataset.enough = String(identifiable > 0);
      words.current.textContent = `${formatSi(Math.max(0, relative), "", 2)}: ${
        identifiable > 0 ? "identifies all parameters" : "this input cannot identify the parameters"
      }`;
    },
    EVERY_MS,
  );

  if (!source) {
    const add = () => {
      void during(() =>
        openVariant(
          { "identifiers.excitation": { kind: "excitation" } },
          "The bench restarts with an excitation monitor.",
        ),
      );
    };
    return (
      <p className={styles.nometer}>
        This bench has no excitation monitor.{" "}
        {teaches && (
          <Button size="compact-xs" variant="light" loading={busy} onClick={add}>
            Restart with an excitation monitor
          </Button>
        )}
      </p>
    );
  }
  return (
    <div className={`row ${styles.meter}`}>
      <span>Excitation</span>
      <div
        ref={fill}
        className={styles.gauge}
        style={{ "--least": `${100 * meterShare(least)}%` } as React.CSSProperties}
      >
        <i title={`least that will do: ${formatShort(least, "")}`} />
      </div>
      <b ref={words} />
    </div>
  );
}

const LOWEST = 1e-9;

/** Place of a relative excitation on a logarithmic meter from 1e-9 to 1. */
export function meterShare(relative: number): number {
  if (!(relative > LOWEST)) return 0;
  return Math.min(1, 1 - Math.log10(relative) / Math.log10(LOWEST));
}
