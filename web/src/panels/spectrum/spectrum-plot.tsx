import { type Ref, useEffect, useImperativeHandle, useMemo, useRef } from "react";
import { usePanelVisible } from "../../api/panel-visible";
import { useView } from "../../bench/view-store";
import type { TakePicture } from "../../picture/picture-menu";
import { middles } from "../../stream/panel-frame";
import { stream } from "../../stream/stream";
import { useFeed } from "../../stream/use-feed";
import type { Subscription } from "../../stream/wire";
import { formatSi } from "../../ui/format";
import { useCanvas, useScheme } from "../../ui/use-canvas";
import styles from "../phase/phase.module.css";
import { useTraces } from "../scope/use-traces";
import { spectrum, strongest } from "./fourier";
import { paintSpectrum, type SpectrumShown, spectrumPicture } from "./paint-spectrum";

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
  picture: Ref<TakePicture>;
}

/** The canvas of a spectrum, and the strongest tone in words. */
export function SpectrumPlot({ signal, ticks, dtMs, highest, picture }: SpectrumPlotProps) {
  const scheme = useScheme();
  const fontSize = useView((s) => s.fontPx);
  const visible = usePanelVisible();
  const names = useMemo(() => [signal], [signal]);
  const [trace] = useTraces(names);
  const { canvas, size } = useCanvas();
  const reading = useRef<HTMLParagraphElement>(null);
  const samples = useRef(new Float32Array(0));
  const next = useRef(0);
  const top = useRef(LOWEST);
  const shown = useRef<SpectrumShown | undefined>(undefined);
  useImperativeHandle(picture, () => () => shown.current && spectrumPicture(shown.current, words(signal)), [signal]);

  const subscription = useMemo<Subscription>(
    () => ({ mode: "roll", signals: names, window_ms: ticks * dtMs, width: ticks }),
    [names, ticks, dtMs],
  );
  useFeed(subscription, (frame) => {
    samples.current = middles(frame, 0).filter(Number.isFinite);
  });

  // biome-ignore lint/correctness/useExhaustiveDependencies: another signal begins with another axis
  useEffect(() => {
    top.current = LOWEST;
  }, [signal]);

  useEffect(() => {
    if (!visible || !trace) return;
    next.current = 0;
    return stream.loop.add(() => {
      const ctx = canvas.current?.getContext("2d");
      const now = performance.now();
      if (!ctx || now < next.current || size.width < 80 || size.height < 80) return;
      if (samples.current.length < LEAST_SAMPLES) return;
      next.current = now + EVERY_MS;
      const found = spectrum(samples.current, dtMs);
      const tone = strongest(found);
      if (tone) top.current = Math.max(Math.ceil(Math.log10(tone.amplitude)), top.current - 0.05);
      if (reading.current)
        reading.current.textContent = tone
          ? `Strongest: ${formatSi(tone.amplitude, trace.unit, 3)} at ${formatSi(tone.frequency, "kHz", 4)}`
          : "Nothing moves.";
      const upper = Math.ceil(top.current);
      ctx.setTransform(size.ratio, 0, 0, size.ratio, 0, 0);
      ctx.clearRect(0, 0, size.width, size.height);
      shown.current = {
        spectrum: found,
        highest,
        decades: [upper - DECADES, upper],
        unit: trace.unit,
        slot: trace.slot,
      };
      paintSpectrum(ctx, size, shown.current, { scheme, fontSize });
    });
  }, [visible, canvas, size, trace, dtMs, highest, scheme, fontSize]);

  return (
    <>
      <div className={styles.plot}>
        <canvas
          ref={canvas}
          className={styles.canvas}
          role="img"
          aria-label={`Amplitude spectrum of ${words(signal)}`}
        />
      </div>
      <p ref={reading} className={styles.words} data-lines="1" />
    </>
  );
}

const words = (name: string) => name.replaceAll(/[._]/g, " ");
