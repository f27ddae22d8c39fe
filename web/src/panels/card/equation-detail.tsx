import type { Equation } from "../../api/types";
import { Formula } from "../../ui/formula";
import { Prose } from "../../ui/prose";
import styles from "./card.module.css";

/** An erratum: what was printed, what works, and why. */
export function EquationDetail({ equation }: { equation: Equation }) {
  return (
    <div className={styles.printed}>
      <h3>As printed</h3>
      <Printed text={equation.printed ?? ""} />
      <h3>As it works</h3>
      <Formula latex={equation.latex} />
      {equation.why && (
        <>
          <h3>Why</h3>
          <p>
            <Prose text={equation.why} />
          </p>
        </>
      )}
    </div>
  );
}

/** What was printed is an equation, or words about one. */
function Printed({ text }: { text: string }) {
  return /[\\^_=]/.test(text) ? (
    <Formula latex={text} />
  ) : (
    <p>
      <Prose text={text} />
    </p>
  );
}
