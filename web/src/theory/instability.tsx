import { NativeSelect } from "@mantine/core";
import { useEffect, useState } from "react";
import { api } from "../api/api";
import { useAsked } from "../api/queries";
import type { InstabilityMap, MapSource } from "../api/types";
import { PictureMenu } from "../picture/picture-menu";
import { formatCount, formatNumber, formatPercent, formatSi } from "../ui/format";
import { Formula } from "../ui/formula";
import { NumberField } from "../ui/number-field";
import { useCanvas } from "../ui/use-canvas";
import { useScheme } from "../ui/use-scheme";
import { cellAt, FIELD, paintMap, STILL } from "./paint-map";
import { printMap } from "./print-theory";
import styles from "./theory.module.css";

type Rule = NonNullable<MapSource["rule"]>;

const RULES: { value: Rule; label: string; latex: string }[] = [
  { value: "mit", label: "MIT rule", latex: "\\dot k_c=B\\,e\\,y_m" },
  { value: "parks", label: "Lyapunov (Parks), as derived", latex: "\\dot k_c=B\\,\\dot e\\,r" },
  { value: "lyapunov", label: "Lyapunov, with the error", latex: "\\dot k_c=B\\,(\\dot e+c\\,e)\\,r" },
  { value: "dressler", label: "Dressler", latex: "\\dot k_c=B\\,e\\,r" },
  { value: "price", label: "Price", latex: "\\dot k_c=B\\,e\\,r+\\gamma\\frac{d}{dt}(B\\,e\\,r)" },
  {
    value: "monopoli",
    label: "Monopoli",
    latex: "\\dot k_c=B\\,e\\,y+\\gamma\\frac{d}{dt}(B\\,e\\,y),\\quad y=\\frac{r}{1+qs},\\quad u=k_cr+q\\dot k_cy",
  },
];
const CELLS = 44;

/** Where the rules of appendix B are unstable, over the frequency of the drive and the adaptation gain. */
export function Instability() {
  const [rule, setRule] = useState<Rule>("mit");
  const [b1, setB1] = useState(0.2);
  const [highest, setHighest] = useState(1);
  const body: MapSource = {
    rule,
    b1,
    b2: 1,
    gain: 1,
    model_gain: 1,
    amplitude: 1,
    error_weight: 0.1,
    proportional: 5,
    filter_time: 6,
    lowest_frequency: 0.2,
    highest_frequency: 2,
    highest_gain: highest,
    frequencies: CELLS,
    gains: CELLS,
  };
  const { answer, refusal, waiting } = useAsked(["instability map", body], () => api.instabilityMap(body));
  const chosen = RULES.find((r) => r.value === rule) ?? RULES[0];
  return (
    <section className={styles.card} aria-label="Instability map">
      <h2>Where does the rule run away?</h2>
      <p className={styles.advice}>
        One gain adapted on k/(s² + b₁s + 1) under a sine. Red grows, green settles; each point is the growth of the
        worst solution by Floquet's theorem.
      </p>
      <div className={styles.examples}>
        <NativeSelect
          size="xs"
          aria-label="Rule"
          value={rule}
          data={RULES.map(({ value, label }) => ({ value, label }))}
          onChange={(e) => setRule(e.currentTarget.value as Rule)}
        />
        <span className={styles.field}>
          damping b₁
          <NumberField label="Damping b1" unit="" value={b1} minimum={0.001} maximum={10} onCommit={setB1} />
        </span>
        <span className={styles.field}>
          gains up to
          <NumberField
            label="Highest gain"
            unit=""
            value={highest}
            minimum={0.01}
            maximum={100}
            onCommit={setHighest}
          />
        </span>
        {answer && <PictureMenu name="instability map" take={() => printMap(answer, chosen.label)} />}
      </div>
      <Formula latex={chosen.latex} />
      {refusal && (
        <p role="alert" className={styles.wrong}>
          {refusal.body.message}
        </p>
      )}
      {answer ? (
        <div className={styles.answer} data-waiting={waiting}>
          <MapPicture map={answer} name={chosen.label} />
          <p className={styles.advice}>
            {unstableShare(answer)} of the map is unstable.{" "}
            {answer.critical_gain_constant === null
              ? "Under a constant no gain on the map is."
              : `Under a constant it is beyond ${formatSi(answer.critical_gain_constant, "")}.`}
          </p>
        </div>
      ) : (
        !refusal && <p className={styles.advice}>Working out {formatCount(CELLS * CELLS, "point")}.</p>
      )}
    </section>
  );
}

function MapPicture({ map, name }: { map: InstabilityMap; name: string }) {
  const scheme = useScheme();
  const { canvas, size } = useCanvas();
  const [at, setAt] = useState<{ frequency: number; gain: number; growth: number } | undefined>(undefined);
  useEffect(() => {
    const ctx = canvas.current?.getContext("2d");
    if (!ctx || size.width < 80) return;
    ctx.setTransform(size.ratio, 0, 0, size.ratio, 0, 0);
    ctx.clearRect(0, 0, size.width, size.height);
    paintMap(ctx, map, size.width, size.height, scheme);
  }, [canvas, size, map, scheme]);
  return (
    <>
      <div
        className={styles.map}
        onPointerMove={(e) => setAt(cellAt(map, e.nativeEvent.offsetX, e.nativeEvent.offsetY, size.width, size.height))}
        onPointerLeave={() => setAt(undefined)}
      >
        <canvas
          ref={canvas}
          role="img"
          aria-label={`${name}: growth over frequency and gain; ${unstableShare(map)} unstable`}
        />
      </div>
      <p className={styles.reading} style={{ paddingLeft: FIELD.left }}>
        {at
          ? `ω = ${formatNumber(at.frequency, 2)}, gain ${formatSi(at.gain, "", 3)}: ${
              at.growth > STILL ? `grows by e every ${formatSi(1 / at.growth, "", 3)}` : "settles"
            }`
          : "Point at the map to read it"}
      </p>
    </>
  );
}

function unstableShare({ growth }: InstabilityMap): string {
  const cells = growth.flat();
  return formatPercent(cells.filter((g) => g > STILL).length / cells.length, 0);
}
