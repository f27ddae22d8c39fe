import type { Equation } from "../api/types";
import styles from "./equation-detail.module.css";
import { Formula } from "./formula";
import { Prose } from "./prose";

/** An erratum: the printed equation, the working one, and the reason. */
export function EquationDetail({ equation }: { equation: Equation }) {
  return (
    <div className={styles.printed}>
      <div>
        <h3>As printed</h3>
        <Printed text={equation.printed ?? ""} />
      </div>
      <div>
        <h3>As it works</h3>
        <Formula latex={equation.latex} />
      </div>
      {equation.why && (
        <div>
          <h3>Why</h3>
          <p>
            <Prose text={equation.why} />
          </p>
        </div>
      )}
    </div>
  );
}

/** The printed text is an equation, or words about an equation. */
function Printed({ text }: { text: string }) {
  return /[\\^_=]/.test(text) ? (
    <Formula latex={text} />
  ) : (
    <p>
      <Prose text={text} />
    </p>
  );
}
