import { useMemo, useState } from "react";
import { useCatalog } from "../../api/use-catalog";
import { useBench } from "../../stream/bench-store";
import { useFeed } from "../../stream/use-feed";
import { formatSi } from "../../ui/format";
import { TRACE_COLOURS } from "../../ui/palette";
import { TableHead } from "../../ui/table-head";
import { useScheme } from "../../ui/use-canvas";
import type { Board, Compared } from "./boards";
import { type TrackingFigures, trackingFigures } from "./tracking-figures";
import styles from "./twins.module.css";

const PERIODS = 4;
const MOST_TICKS = 2000;
const USUAL_TICKS = 400;
const EVERY_MS = 500;

/** Errors and efforts of each board over the last periods of the drive. */
export function TwinFigures({ boards, compared }: { boards: Board[]; compared: Compared }) {
  const scheme = useScheme();
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  const signals = useBench((s) => s.bench?.signals);
  const period = useBench((s) => s.bench?.drive_period_ticks);
  const { block } = useCatalog();
  const [figures, setFigures] = useState<TrackingFigures[]>([]);
  const ticks = Math.min(MOST_TICKS, Math.round(period ? PERIODS * period : USUAL_TICKS));
  const subscription = useMemo(
    () => ({
      mode: "roll" as const,
      signals: [compared.ideal, ...boards.flatMap((board) => valuesOf(board, compared))],
      window_ms: ticks * dtMs,
      width: ticks,
    }),
    [boards, compared, ticks, dtMs],
  );
  useFeed(
    dtMs > 0 ? subscription : undefined,
    (frame) => {
      const each = 1 + compared.efforts.length;
      setFigures(
        boards.map((_, i) => {
          const at = 1 + each * i;
          const efforts = compared.efforts.map((_, j) => at + 1 + j);
          return trackingFigures(frame, at, 0, efforts);
        }),
      );
    },
    EVERY_MS,
  );
  const unitOf = (name: string) => signals?.find((s) => s.name === name)?.unit ?? "";
  const best = Math.min(...figures.map((f) => f.rmsError).filter(Number.isFinite));
  return (
    <div className={styles.scroll}>
      <table className={`numbers ${styles.table}`}>
        <caption>
          Against {compared.against}, over the last {formatSi(ticks * dtMs, "ms")}
        </caption>
        <TableHead
          names={["Board", "rms error", "Peak error", ...compared.efforts.map(({ title }) => `rms ${title}`)]}
        />
        <tbody>
          {boards.map(({ name, prefix, chosen, slot }, i) => (
            <tr key={prefix}>
              <th scope="row">
                <i style={{ background: TRACE_COLOURS[scheme][slot] }} />
                {name}
                <small>{block("control", chosen)?.title ?? chosen.replaceAll("_", " ")}</small>
              </th>
              <td data-best={figures[i]?.rmsError === best}>{show(figures[i]?.rmsError, unitOf(compared.ideal))}</td>
              <td>{show(figures[i]?.peakError, unitOf(compared.ideal))}</td>
              {compared.efforts.map(({ title, signal }, j) => (
                <td key={title}>{show(figures[i]?.efforts[j], unitOf(signal))}</td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

const valuesOf = (board: Board, { value, efforts }: Compared): string[] => [
  value(board),
  ...efforts.map(({ signal }) => board.prefix + signal),
];

const show = (value: number | undefined, unit: string) =>
  value === undefined ? "–" : Number.isFinite(value) ? formatSi(value, unit, 3) : "at rest";
