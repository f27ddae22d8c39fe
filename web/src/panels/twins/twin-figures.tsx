import { useMemo, useState } from "react";
import { useCatalog } from "../../api/use-catalog";
import { useScheme } from "../../app/use-scheme";
import { useBench } from "../../stream/bench-store";
import { useFeed } from "../../stream/use-feed";
import { formatSi } from "../../ui/format";
import { TRACE_COLOURS } from "../../ui/palette";
import type { Board } from "./boards";
import { type TrackingFigures, trackingFigures } from "./tracking-figures";
import styles from "./twins.module.css";

const PERIODS = 4;
const MOST_TICKS = 2000;
const USUAL_TICKS = 400;
const EVERY_MS = 500;

/** How well each board follows the model, and at what cost, over the last periods of the drive. */
export function TwinFigures({ boards }: { boards: Board[] }) {
  const scheme = useScheme();
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  const period = useBench((s) => s.bench?.drive_period_ticks);
  const { block } = useCatalog();
  const [figures, setFigures] = useState<TrackingFigures[]>([]);
  const ticks = Math.min(MOST_TICKS, Math.round(period ? PERIODS * period : USUAL_TICKS));
  const subscription = useMemo(
    () => ({
      mode: "roll" as const,
      signals: [
        "model.displacement",
        ...boards.flatMap(({ prefix }) => [`${prefix}plant.displacement`, `${prefix}drive.voltage`]),
      ],
      window_ms: ticks * dtMs,
      width: ticks,
    }),
    [boards, ticks, dtMs],
  );
  useFeed(
    dtMs > 0 ? subscription : undefined,
    (frame) => {
      setFigures(boards.map((_, i) => trackingFigures(frame, 1 + 2 * i, 0, 2 + 2 * i)));
    },
    EVERY_MS,
  );
  const best = Math.min(...figures.map((f) => f.rmsError).filter(Number.isFinite));
  return (
    <div className={styles.scroll}>
      <table className={styles.table}>
        <caption>Against the reference model, over the last {formatSi(ticks * dtMs, "ms")}</caption>
        <thead>
          <tr>
            <th scope="col">Board</th>
            <th scope="col">rms error</th>
            <th scope="col">Peak error</th>
            <th scope="col">rms effort</th>
          </tr>
        </thead>
        <tbody>
          {boards.map(({ name, prefix, controller, slot }, i) => (
            <tr key={prefix}>
              <th scope="row">
                <i style={{ background: TRACE_COLOURS[scheme][slot] }} />
                {name}
                <small>{block("control", controller)?.title ?? controller.replaceAll("_", " ")}</small>
              </th>
              <td data-best={figures[i]?.rmsError === best}>{show(figures[i]?.rmsError, "um")}</td>
              <td>{show(figures[i]?.peakError, "um")}</td>
              <td>{show(figures[i]?.effort, "V")}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

const show = (value: number | undefined, unit: string) =>
  value === undefined ? "–" : Number.isFinite(value) ? formatSi(value, unit, 3) : "at rest";
