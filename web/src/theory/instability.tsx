import { Box, NativeSelect } from "@mantine/core";
import { useCallback, useState } from "react";
import { api } from "../api/api";
import { useAsked } from "../api/queries";
import type { InstabilityMap, MapSource } from "../api/types";
import { Painted } from "../picture/painted";
import type { Look, Box as Paper, Pen } from "../picture/pen";
import { PictureMenu } from "../picture/picture-menu";
import { formatCount, formatNumber, formatPercent, formatShort, formatSi } from "../ui/format";
import { Formula } from "../ui/formula";
import { NumberField } from "../ui/number-field";
import { cellAt, mapPicture, paintMap, STILL } from "./paint-map";
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
    <section className="card essay" aria-label="Instability map">
      <h2>Where is the rule unstable?</h2>
      <p className="note">
        One gain adapted on k/(s² + b₁s + 1) under a sine. In orange the error grows, in blue it decays. Each point
        shows how fast the worst solution grows, by Floquet's theorem.
      </p>
      <div className={`row ${styles.examples}`}>
        <NativeSelect
          aria-label="Rule"
          value={rule}
          data={RULES.map(({ value, label }) => ({ value, label }))}
          onChange={(e) => setRule(e.currentTarget.value as Rule)}
        />
        <span className="line note">
          damping b₁
          <NumberField label="Damping b1" unit="" value={b1} minimum={0.001} maximum={10} onCommit={setB1} />
        </span>
        <span className="line note">
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
        {answer && <PictureMenu name="instability map" take={() => mapPicture(answer, chosen.label)} />}
      </div>
      <Formula latex={chosen.latex} />
      {refusal && (
        <Box component="p" role="alert" className="wrong" my={4}>
          {refusal.body.message}
        </Box>
      )}
      {answer ? (
        <div className={styles.answer} data-waiting={waiting}>
          <MapPicture map={answer} name={chosen.label} />
          <p className="note">
            {unstableShare(answer)} of the map is unstable.{" "}
            {answer.critical_gain_constant === null
              ? "Under a constant input the rule is stable at every gain of the map."
              : `Under a constant input the rule is unstable at gains above ${formatShort(answer.critical_gain_constant, "")}.`}
          </p>
        </div>
      ) : (
        !refusal && <p className="note">Working out {formatCount(CELLS * CELLS, "point")}.</p>
      )}
    </section>
  );
}

function MapPicture({ map, name }: { map: InstabilityMap; name: string }) {
  const [at, setAt] = useState<ReturnType<typeof cellAt>>(undefined);
  const paint = useCallback((pen: Pen, box: Paper, look: Look) => paintMap(pen, box, map, look), [map]);
  return (
    <>
      <Box h={340} style={{ cursor: "crosshair" }}>
        <Painted
          label={`${name}: growth over frequency and gain; ${unstableShare(map)} unstable`}
          paint={paint}
          onPoint={(point, plot) => setAt(point && cellAt(map, plot, point))}
        />
      </Box>
      <Box component="p" mih="1.4em" mb={4} pl={44} fz="sm" fw={560}>
        {at
          ? `ω = ${formatNumber(at.frequency, 2)}, gain ${formatSi(at.gain, "", 3)}: ${
              at.growth > STILL ? `grows by e every ${formatSi(1 / at.growth, "", 3)}` : "settles"
            }`
          : "Point at the map to read it"}
      </Box>
    </>
  );
}

function unstableShare({ growth }: InstabilityMap): string {
  const cells = growth.flat();
  return formatPercent(cells.filter((g) => g > STILL).length / cells.length, 0);
}
