import { Box } from "@mantine/core";
import type { ReactNode } from "react";
import { PageHead } from "../bench/page-head";
import { openPlace, useView } from "../bench/view-store";
import { PageTabs } from "../ui/page-tabs";
import { EquationIndex } from "./equation-index";
import { Excitation } from "./excitation";
import { Instability } from "./instability";
import { PositiveReal } from "./positive-real";

/** A calculator by its title, or the equations that the place names. */
function Paper({ title, children }: { title?: string; children: ReactNode }) {
  const asked = useView((s) => s.item);
  return (
    <div className="paper">
      <Box component="header" className="card" p="8px 16px">
        <PageHead name="Theory" item={title ?? asked} />
      </Box>
      {children}
    </div>
  );
}

const calculator = (title: string, body: ReactNode) => ({ title, body: <Paper title={title}>{body}</Paper> });

const EQUATIONS = "equations";
const TABS = {
  [EQUATIONS]: {
    title: "Equations",
    body: (
      <Paper>
        <EquationIndex />
      </Paper>
    ),
  },
  "positive-real": calculator("Positive real", <PositiveReal />),
  excitation: calculator("Excitation", <Excitation />),
  stability: calculator("Stability", <Instability />),
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
