import { Box, Group } from "@mantine/core";
import { useMemo, useRef } from "react";
import { usePanelVisible } from "../../api/panel-visible";
import { useBench } from "../../stream/bench-store";
import { middles } from "../../stream/panel-frame";
import { useFeed } from "../../stream/use-feed";
import { formatShort, formatSi } from "../../ui/format";
import { useRestingTick } from "../../ui/hover";
import { RestartButton } from "../restart/restart-button";
import styles from "./adaptation.module.css";

const EVERY_MS = 150;
const USUAL_LEAST = 1e-5;

/** Excitation by the input now, or at the tick under a resting pointer: the smallest eigenvalue of the windowed Gram matrix of the regressor, and the least that suffices. */
export function ExcitationMeter() {
  const signals = useBench((s) => s.bench?.signals);
  const parameters = useBench((s) => s.bench?.parameters);
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

  if (!source)
    return (
      <Box component="p" c="dimmed" p="2px 12px 6px">
        This bench has no excitation monitor.{" "}
        <RestartButton
          size="compact-xs"
          variant="light"
          set={{ "identifiers.excitation": { kind: "excitation" } }}
          said="The bench restarts with an excitation monitor."
        >
          Restart with an excitation monitor
        </RestartButton>
      </Box>
    );
  return (
    <Group gap="2px 10px" p="2px 12px 8px">
      <span className="note">Excitation</span>
      <div
        ref={fill}
        className={styles.gauge}
        style={{ "--least": `${100 * meterShare(least)}%` } as React.CSSProperties}
      >
        <i title={`least that suffices: ${formatShort(least, "")}`} />
      </div>
      <Box component="b" ref={words} flex="1 1 30ch" fw={560} />
    </Group>
  );
}

const LOWEST = 1e-9;

/** Place of a relative excitation on a logarithmic meter from 1e-9 to 1. */
export function meterShare(relative: number): number {
  if (!(relative > LOWEST)) return 0;
  return Math.min(1, 1 - Math.log10(relative) / Math.log10(LOWEST));
}
