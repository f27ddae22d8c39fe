import type { ReactNode } from "react";
import { showTab, useView } from "../bench/view-store";
import { PageTabs } from "../ui/page-tabs";
import { EquationIndex } from "./equation-index";
import { Excitation } from "./excitation";
import { Instability } from "./instability";
import { PositiveReal } from "./positive-real";
import styles from "./theory.module.css";

const paper = (body: ReactNode) => <div className={styles.page}>{body}</div>;

const TABS = {
  equations: { title: "Equations", body: paper(<EquationIndex />) },
  "positive-real": { title: "Positive real", body: paper(<PositiveReal />) },
  excitation: { title: "Excitation", body: paper(<Excitation />) },
  stability: { title: "Stability", body: paper(<Instability />) },
};

/** What can be said of a system before anything is run: every equation with its errata, and appendices A and B. */
export function Theory() {
  const tab = useView((s) => s.tab);
  return <PageTabs title="Theory" tabs={TABS} shown={tab} onShow={showTab} />;
}
