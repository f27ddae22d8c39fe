import type { RateReadout } from "../../api/types";
import { formatIn, formatShort } from "../../ui/format";
import { CANVAS, type Scheme, TRACE_COLOURS } from "../../ui/palette";
import { roundTo } from "../../ui/unit-scale";
import styles from "./allan.module.css";
import { deviation, scatter, TERMS, valuesOf } from "./deviation";

interface AllanPlotProps {
  readout: RateReadout;
  width: number;
  height: number;
  scheme: Scheme;
}

const LEFT = 62;
const RIGHT = 14;
const TOP = 10;
const BOTTOM = 40;
const POINTS = 64;

/** Colours and dashes of what is drawn, for the plot and its legend. */
export const LINES = {
  measured: { slot: 1, dash: "" },
  fitted: { slot: 2, dash: "8 4" },
  true: { slot: 0, dash: "2 4" },
} as const;

export const lineOf = (name: keyof typeof LINES, scheme: Scheme) => TRACE_COLOURS[scheme][LINES[name].slot];

/** The Allan deviation over the averaging time, both logarithmic: measured, fitted, and that of the rate itself. */
export function AllanPlot({ readout, width, height, scheme }: AllanPlotProps) {
  const { octaves, figures } = readout;
  const fitted = valuesOf(figures, "value");
  const truth = valuesOf(figures, "true");
  const taus = octaves.map((o) => o.tau_s);
  const [x0, x1] = decades(taus.length ? taus : [0.001, 1]);
  const [y0, y1] = decades(octaves.length ? octaves.map((o) => o.deviation_deg_h).filter((d) => d > 0) : [1, 1000]);
  const wide = width - LEFT - RIGHT;
  const tall = height - TOP - BOTTOM;
  const px = (tau: number) => roundTo(LEFT + ((Math.log10(tau) - x0) / (x1 - x0)) * wide, 5);
  const py = (value: number) => roundTo(TOP + tall - ((Math.log10(Math.max(value, 1e-12)) - y0) / (y1 - y0)) * tall, 5);
  const path = (of: (tau: number) => number, from = 10 ** x0, to = 10 ** x1) =>
    Array.from({ length: POINTS + 1 }, (_, i) => {
      const tau = from * (to / from) ** (i / POINTS);
      return `${i ? "L" : "M"}${px(tau)} ${py(of(tau))}`;
    }).join("");
  const ink = CANVAS[scheme];
  const measured = lineOf("measured", scheme);
  const hasFit = Object.keys(fitted).length > 0;
  return (
    <svg
      width={width}
      height={height}
      role="img"
      aria-label="Allan deviation over averaging time"
      className={styles.field}
    >
      <defs>
        <clipPath id="allan-field">
          <rect x={LEFT} y={TOP} width={wide} height={tall} />
        </clipPath>
      </defs>
      {powers(x0, x1).map((p) => (
        <g key={`x${p}`}>
          <path d={`M${px(10 ** p)} ${TOP}v${tall}`} stroke={ink.grid} />
          <text x={px(10 ** p)} y={TOP + tall + 15} textAnchor="middle">
            {p < 0 ? formatShort(10 ** p, "s") : formatIn(10 ** p, "s", 0)}
          </text>
        </g>
      ))}
      {powers(y0, y1).map((p) => (
        <g key={`y${p}`}>
          <path d={`M${LEFT} ${py(10 ** p)}h${wide}`} stroke={ink.grid} />
          <text x={LEFT - 6} y={py(10 ** p) + 4} textAnchor="end">
            {formatShort(10 ** p, "")}
          </text>
        </g>
      ))}
      <text x={LEFT + wide / 2} y={height - 6} textAnchor="middle" className={styles.axis}>
        averaging time
      </text>
      <text transform={`translate(13 ${TOP + tall / 2}) rotate(-90)`} textAnchor="middle" className={styles.axis}>
        deviation, deg/h
      </text>
      <g clipPath="url(#allan-field)" fill="none">
        {Object.keys(truth).length > 0 && (
          <path
            d={path((tau) => deviation(truth, tau))}
            stroke={lineOf("true", scheme)}
            strokeWidth={1.6}
            strokeDasharray={LINES.true.dash}
          />
        )}
        {Object.entries(fitted).map(([letter, value]) => (
          <path
            key={letter}
            d={path((tau) => TERMS[letter](value, tau))}
            stroke={lineOf("fitted", scheme)}
            opacity={0.55}
          />
        ))}
        {hasFit && (
          <path
            d={path((tau) => deviation(fitted, tau), readout.from_s, readout.to_s)}
            stroke={lineOf("fitted", scheme)}
            strokeWidth={2.2}
            strokeDasharray={LINES.fitted.dash}
          />
        )}
        {octaves.map((octave, i) => {
          const share = Math.min(0.9, scatter(i, octave.pairs));
          const at = px(octave.tau_s);
          return (
            <g key={octave.tau_s} stroke={measured}>
              <path
                d={`M${at} ${py(octave.deviation_deg_h * (1 - share))}V${py(octave.deviation_deg_h * (1 + share))}`}
              />
              <circle cx={at} cy={py(octave.deviation_deg_h)} r={3} fill={measured} />
            </g>
          );
        })}
      </g>
    </svg>
  );
}

/** Whole decades about some values, as powers of ten. */
function decades(values: readonly number[]): [number, number] {
  const low = Math.floor(Math.log10(Math.min(...values)) + 1e-9);
  return [low, Math.max(low + 1, Math.ceil(Math.log10(Math.max(...values)) - 1e-9))];
}

const powers = (low: number, high: number) => Array.from({ length: high - low + 1 }, (_, i) => low + i);
