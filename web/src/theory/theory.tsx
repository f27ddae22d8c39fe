import { PageHead } from "../bench/page-head";
import { useView } from "../bench/view-store";
import { EquationIndex } from "./equation-index";
import { Excitation } from "./excitation";
import { Instability } from "./instability";
import { PositiveReal } from "./positive-real";
import styles from "./theory.module.css";

/** What can be said of a system before anything is run: appendices A and B, and every equation with its errata. */
export function Theory() {
  return (
    <main className={styles.page}>
      <header className={styles.top}>
        <PageHead name="Theory" item={useView((s) => s.item)} />
      </header>
      <div className={styles.cards}>
        <PositiveReal />
        <Excitation />
        <Instability />
      </div>
      <EquationIndex />
    </main>
  );
}
