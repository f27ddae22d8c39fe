import type { ReactNode } from "react";
import { PageHead } from "../bench/page-head";
import { openPlace, useView } from "../bench/view-store";
import { PageTabs } from "../ui/page-tabs";
import { EquationIndex } from "./equation-index";
import { Excitation } from "./excitation";
import { Instability } from "./instability";
import { PositiveReal } from "./positive-real";
import styles from "./theory.module.css";

const paper = (title: string, body: ReactNode) => ({
  title,
  body: (
    <div className={styles.page}>
      <header className={styles.top}>
        <PageHead name="Theory" item={title} heading={title} />
      </header>
      {body}
    </div>
  ),
});

const EQUATIONS = "equations";
const TABS = {
  [EQUATIONS]: paper("Equations", <EquationIndex />),
  "positive-real": paper("Positive real", <PositiveReal />),
  excitation: paper("Excitation", <Excitation />),
  stability: paper("Stability", <Instability />),
};

/** Every equation with its errata, and calculators for appendices A and B; a place of no tab finds equations by its words. */
export function Theory() {
  const item = useView((s) => s.item);
  return (
    <PageTabs
      title="Theory"
      tabs={TABS}
      shown={item in TABS ? item : EQUATIONS}
      onShow={(tab) => openPlace("theory", tab === EQUATIONS ? "" : tab)}
    />
  );
}
