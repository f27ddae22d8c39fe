import { NativeSelect, Box as Place, Stack } from "@mantine/core";
import { useCallback, useMemo, useState } from "react";
import { api } from "../api/api";
import { useAnswer, useLast } from "../api/queries";
import type { SweepRun } from "../api/types";
import { Figure } from "../picture/figure";
import type { Box, Look, Pen } from "../picture/pen";
import { formatCount } from "../ui/format";
import { metricScale } from "../ui/metric-name";
import { rampColour } from "../ui/palette";
import { Stale } from "../ui/stale";
import { useScheme } from "../ui/use-canvas";
import { cellText, extentText, mostIn, paintDistribution, type Shown } from "./paint-distribution";
import { labelScale } from "./points";
import styles from "./runs.module.css";

interface DistributionChartProps {
  sweep: SweepRun;
  /** The quantities over which runs can be counted. */
  quantities: readonly string[];
  figures: readonly string[];
  /** The figure to begin with. */
  first: string | undefined;
  /** Asked again after so long, ms. */
  every: number | undefined;
}

/** How runs are spread over one quantity or two: a histogram, dots of few runs, a density of many. */
export function DistributionChart({ sweep, quantities, figures, first, every }: DistributionChartProps) {
  const varied = quantities.find((name) => name !== "seed" && !figures.includes(name));
  const figure = first ?? figures[0] ?? "seed";
  const [across, setAcross] = useState<string | undefined>(undefined);
  const [up, setUp] = useState<string | undefined>(undefined);
  const x = across ?? varied ?? figure;
  const y = up ?? (varied ? figure : "");
  const { value: newest, ...answer } = useAnswer(
    ["sweep distribution", sweep.id, sweep.state, x, y],
    () => api.sweepDistribution(sweep.id, { x, y: y || undefined }),
    () => every,
  );
  const value = useLast(newest);
  const shown = useMemo((): Shown | undefined => {
    if (!value) return undefined;
    const scale = (extent: typeof value.x) =>
      (figures.includes(extent.name) ? metricScale : labelScale)(extent.name, [extent.low, extent.high]);
    return { found: value, x: scale(value.x), y: value.y ? scale(value.y) : undefined };
  }, [value, figures]);
  const names = quantities.map((name) => ({
    value: name,
    label: figures.includes(name) ? metricScale(name, []).title : labelScale(name, []).title,
  }));
  return (
    <Stack component="section" gap={12} aria-label="Distribution of runs">
      <h3>Distribution of runs</h3>
      <div className={`row ${styles.links}`}>
        <NativeSelect label="Across" value={x} data={names} onChange={(e) => setAcross(e.currentTarget.value)} />
        <NativeSelect
          label="Up"
          value={y}
          data={[{ value: "", label: "number of runs" }, ...names]}
          onChange={(e) => setUp(e.currentTarget.value)}
        />
      </div>
      <Stale error={answer.error} since={answer.since} onRetry={answer.again} />
      {shown && <Chart shown={shown} />}
    </Stack>
  );
}

function Chart({ shown }: { shown: Shown }) {
  const { found, x, y } = shown;
  const paint = useCallback((pen: Pen, box: Box, look: Look) => paintDistribution(pen, box, shown, look), [shown]);
  const kind = !y ? "Histogram" : found.dots ? "Runs" : "Density of runs";
  const title = y ? `${kind}: ${y.name} over ${x.name}` : `${kind} of ${x.name}`;
  return (
    <Figure
      title={title}
      label={`${title}; ${formatCount(found.runs, "run")}, ${extentText(shown)}`}
      height={340}
      paint={paint}
      read={(at, plot) => cellText(shown, plot, at)}
    >
      {y && !found.dots && <Scale most={mostIn(found)} />}
      <p className="note">{formatCount(found.runs, "run")}. Point at the plot to read it.</p>
    </Figure>
  );
}

/** The meaning of each colour. */
function Scale({ most }: { most: number }) {
  const scheme = useScheme();
  const colours = [0, 0.25, 0.5, 0.75, 1].map((share) => rampColour(share, scheme));
  return (
    <p className="line remark">
      <span>runs in a cell: 1</span>
      <Place component="span" w="min(220px, 40%)" h={10} bg={`linear-gradient(to right, ${colours.join(", ")})`} />
      <span>{most} (logarithmic)</span>
    </p>
  );
}
