import type { HiddenAnswer } from "../../api/types";
import exercise from "../../ui/exercise.module.css";
import { formatChange, formatSi } from "../../ui/format";
import { TableHead } from "../../ui/table-head";
import styles from "./blind.module.css";

type Shown = NonNullable<HiddenAnswer["healthy"]>;

const FIGURES: { key: keyof Shown; words: string; unit: string }[] = [
  { key: "f0_hz", words: "Resonance f₀", unit: "Hz" },
  { key: "quality_factor", words: "Quality factor", unit: "1" },
  { key: "rest_um_per_v", words: "Gain at low frequencies", unit: "um/V" },
  { key: "peak_um_per_v", words: "Gain at the peak", unit: "um/V" },
];

/** A smaller change is none. */
const LEAST = 0.002;

/** Signs of each kind of fault on a device with one displacement. */
const SWEPT: Record<string, string> = {
  mass: "the resonance moves, and the gain at low frequencies stays: mass, not stiffness",
  stiffness: "the resonance moves, and so does the gain at low frequencies: stiffness, not mass",
  damping: "the resonance stays; its peak has another height and width",
  gain: "the whole curve moves up or down, and the resonance stays",
};

/** Signs of each kind of fault of a gyroscope, which no sweep measures. */
const OF_AXES: Record<string, string> = {
  mass: "the Spectrum: both resonances move the same way",
  stiffness: "the Spectrum: both resonances move the same way",
  damping: "Cursors on the scope: the drive needs another force for the same displacement along x",
  second_stiffness: "the Spectrum of the measurement along y: its resonance moves, and along x it stays",
  quadrature_dps: "Cursors on the scope: along y a displacement in step with the displacement along x",
  drive_gain: "Cursors on the scope: along x the same force moves the mass less",
};

/** Which measurement tells the fault that was hidden, with the figures before it and with it. */
export function Telling({ answer }: { answer: HiddenAnswer }) {
  const { truth, factors, healthy, faulty } = answer;
  const parts = Object.keys(factors[truth] ?? {});
  if (!healthy || !faulty)
    return (
      <p className={exercise.text}>
        {parts.length === 0
          ? "No measurement shows a fault: the device is healthy."
          : `Signs of it: ${parts.map((part) => OF_AXES[part] ?? part).join("; ")}.`}
      </p>
    );
  return (
    <>
      <p className={exercise.text}>
        {parts.length === 0
          ? "Frequency response tells it: a sweep finds every figure where it was."
          : `Frequency response tells it: ${parts.map((part) => SWEPT[part] ?? part).join("; ")}.`}
      </p>
      <table className={styles.moved} aria-label="Results of a sweep">
        <TableHead names={["A sweep shows", "healthy", "now", "change"]} />
        <tbody>
          {FIGURES.map(({ key, words, unit }) => {
            const change = faulty[key] / healthy[key] - 1;
            return (
              <tr key={key} data-moved={Math.abs(change) > LEAST}>
                <th scope="row">{words}</th>
                <td>{formatSi(healthy[key], unit, 4)}</td>
                <td>{formatSi(faulty[key], unit, 4)}</td>
                <td>{Math.abs(change) > LEAST ? formatChange(100 * change, "%", 1) : "none"}</td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </>
  );
}
