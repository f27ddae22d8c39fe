import { Select, Stack } from "@mantine/core";
import { useMemo } from "react";
import type { CampaignPicture } from "../api/types";
import { Figure } from "../picture/figure";
import { LineChart } from "../picture/line-chart";
import type { Box, Look, Pen } from "../picture/pen";
import { formatCount, formatNumber } from "../ui/format";
import { type MetricScale, metricScale, metricTitle } from "../ui/metric-name";
import { mapOf, type Part, paintMap, pointAt } from "./paint-map";
import { paintRanks, type RanksShown } from "./paint-ranks";
import { labelScale, pointName } from "./points";
import styles from "./runs.module.css";

interface CampaignFiguresProps {
  picture: CampaignPicture;
  onChoose(chosen: { figure?: string; across?: string }): void;
}

/** The picture of a campaign, as the server chose it: a map, lines, rows, or a ranking with the points behind it. */
export function CampaignFigures({ picture, onChoose }: CampaignFiguresProps) {
  const { kind, figure, figures, parts, ranking, left_out } = picture;
  const scale = metricScale(
    figure,
    parts.flatMap(({ mean }) => mean),
  );
  return (
    <Stack component="section" gap={12} aria-label="Figures">
      <div className={`row ${styles.links}`}>
        <Select
          label="Figure"
          searchable
          allowDeselect={false}
          w={320}
          value={figure}
          data={figures.map((name) => ({ value: name, label: metricTitle(name) }))}
          onChange={(name) => name && onChoose({ figure: name })}
        />
        {kind === "ranking" && (
          <Select
            label="Across"
            allowDeselect={false}
            value={picture.across}
            data={ranking.map(({ name }) => ({ value: name, label: labelScale(name, []).name }))}
            onChange={(name) => name && onChoose({ figure, across: name })}
          />
        )}
      </div>
      <div className="plots">
        {kind === "map" ? (
          parts.map((part) => <MapFigure key={JSON.stringify(part.labels)} {...{ picture, part, scale }} />)
        ) : kind === "rows" ? (
          <Rows picture={picture} scale={scale} />
        ) : (
          <>
            {kind === "ranking" && <Ranking picture={picture} scale={scale} />}
            <Lines picture={picture} scale={scale} />
          </>
        )}
      </div>
      {left_out > 0 && <p className="note">{formatCount(left_out, "more combination")} in the table.</p>}
    </Stack>
  );
}

interface Shown {
  picture: CampaignPicture;
  scale: MetricScale;
}

function MapFigure({ picture, part, scale }: Shown & { part: Part }) {
  const shown = useMemo(() => mapOf(picture, part, scale), [picture, part, scale]);
  const paint = useMemo(() => (pen: Pen, box: Box, look: Look) => paintMap(pen, box, shown, look), [shown]);
  const of = picture.parts.length > 1 ? `: ${pointName(part.labels)}` : "";
  const title = `${scale.title} over ${shown.x.name} and ${shown.y.name}${of}`;
  return (
    <Figure
      title={title}
      label={title}
      height={320}
      paint={paint}
      read={(at, plot) => {
        const i = pointAt(shown, plot, at);
        if (i === undefined) return undefined;
        const where = pointName({ [picture.across]: part.x[i], [picture.up]: part.y[i] });
        return `${where}: ${scale.say(part.mean[i], part.std[i])}`;
      }}
    />
  );
}

function Lines({ picture: { kind, across, parts, low, high }, scale }: Shown) {
  const x = labelScale(
    across,
    parts.flatMap((part) => part.x),
  );
  const lines = useMemo(
    () =>
      parts.map((part) => ({
        name: parts.length > 1 ? pointName(part.labels) : "",
        x: part.x.map(x.shown),
        y: part.mean.map(scale.shown),
        spread: kind === "lines" ? part.std.map(scale.shown) : undefined,
        isDotted: kind === "ranking",
      })),
    [parts, kind, x, scale],
  );
  return (
    <LineChart
      title={`${scale.name} over ${x.name}`}
      xLabel={x.title}
      yLabel={scale.title}
      yRange={[scale.shown(low), scale.shown(high)]}
      lines={lines}
      say={(line, i) =>
        `${pointName({ [across]: parts[line].x[i] })}: ${scale.say(parts[line].mean[i], parts[line].std[i])}`
      }
    />
  );
}

function Rows({ picture: { parts, low, high }, scale }: Shown) {
  const ranks = parts.map(({ labels, mean: [mean], std: [std] }) => ({
    name: pointName(labels),
    value: scale.shown(mean),
    spread: scale.shown(std),
  }));
  const shown = { label: scale.title, span: [scale.shown(low), scale.shown(high)] as const, ranks };
  return (
    <RanksFigure
      title={scale.name}
      shown={shown}
      say={(i) => `${ranks[i].name}: ${scale.say(parts[i].mean[0], parts[i].std[0])}`}
    />
  );
}

function Ranking({ picture: { ranking, chance }, scale }: Shown) {
  const ranks = ranking.map(({ name, correlation }) => ({ name: labelScale(name, []).name, value: correlation }));
  const shown = { label: "rank correlation (grey: by chance)", span: [-1, 1] as const, ranks, chance };
  return (
    <RanksFigure
      title={`${scale.name}: what it goes with`}
      shown={shown}
      say={(i) => `${ranks[i].name}: ${formatNumber(ranks[i].value, 2)}`}
    />
  );
}

const ROW_PX = 26;
const AXIS_PX = 52;

function RanksFigure({ title, shown, say }: { title: string; shown: RanksShown; say(row: number): string }) {
  const paint = useMemo(() => (pen: Pen, box: Box, look: Look) => paintRanks(pen, box, shown, look), [shown]);
  const { ranks, label } = shown;
  return (
    <Figure
      title={title}
      label={`${title}: ${ranks.map((_, i) => say(i)).join("; ")} (${label})`}
      height={AXIS_PX + ROW_PX * ranks.length}
      paint={paint}
      read={({ y }, { field: { top, bottom } }) => {
        const row = Math.floor(((y - top) / (bottom - top)) * ranks.length);
        return ranks[row] && say(row);
      }}
    />
  );
}
