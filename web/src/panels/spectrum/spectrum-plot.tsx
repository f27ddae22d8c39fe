import { type RefObject, useEffect, useMemo, useRef } from "react";
import { LiveCanvas } from "../../picture/live-canvas";
import type { Box, Look, Pen } from "../../picture/pen";
import { middles } from "../../stream/panel-frame";
import type { Subscription } from "../../stream/wire";
import { formatSi } from "../../ui/format";
import styles from "../phase/phase.module.css";
import { useTraces } from "../scope/use-traces";
import { spectrum, strongest } from "./fourier";
import { paintSpectrum, type SpectrumShown } from "./paint-spectrum";

/** A spectrum is read, not watched: ten a second are enough. */
const EVERY_MS = 100;
const DECADES = 6;
const LEAST_SAMPLES = 16;
/** The axis of a signal that has not been seen yet, as a power of ten. */
const LOWEST = -20;

interface SpectrumPlotProps {
  signal: string;
  ticks: number;
  dtMs: number;
  /** Highest frequency shown, kHz. */
  highest: number;
  /** Keeps the newest picture. */
  shown: RefObject<SpectrumShown | undefined>;
}

/** The canvas of a spectrum, and the strongest tone in words. */
export function SpectrumPlot({ signal, ticks, dtMs, highest, shown }: SpectrumPlotProps) {
  const names = useMemo(() => [signal], [signal]);
  const [trace] = useTraces(names);
  const reading = useRef<HTMLParagraphElement>(null);
  const samples = useRef(new Float32Array(0));
  const top = useRef(LOWEST);

  const subscription = useMemo<Subscription>(
    () => ({ mode: "roll", signals: names, window_ms: ticks * dtMs, width: ticks }),
    [names, ticks, dtMs],
  );

  // biome-ignore lint/correctness/useExhaustiveDependencies: another signal begins with another axis
  useEffect(() => {
    top.current = LOWEST;
  }, [signal]);

  const paint = (pen: Pen, box: Box, look: Look) => {
    if (!trace || samples.current.length < LEAST_SAMPLES) return;
    const found = spectrum(samples.current, dtMs);
    const tone = strongest(found);
    if (tone) top.current = Math.max(Math.ceil(Math.log10(tone.amplitude)), top.current - 0.05);
    if (reading.current)
      reading.current.textContent = tone
        ? `Strongest: ${formatSi(tone.amplitude, trace.unit, 3)} at ${formatSi(tone.frequency, "kHz", 4)}`
        : "Nothing moves.";
    const upper = Math.ceil(top.current);
    const { unit, slot } = trace;
    shown.current = { spectrum: found, highest, decades: [upper - DECADES, upper], unit, slot };
    paintSpectrum(pen, box, shown.current, look);
  };

  return (
    <>
      <LiveCanvas
        label={`Amplitude spectrum of ${signal.replaceAll(/[._]/g, " ")}`}
        subscription={subscription}
        hear={(frame) => {
          samples.current = middles(frame, 0).filter(Number.isFinite);
        }}
        paint={paint}
        everyMs={EVERY_MS}
      />
      <p ref={reading} className={styles.words} data-lines="1" />
    </>
  );
}
