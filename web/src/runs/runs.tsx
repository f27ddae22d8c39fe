import { useMay } from "../api/me";
import { showTab, useView } from "../bench/view-store";
import { BenchmarkPage } from "../benchmark/benchmark-page";
import { PageTabs } from "../ui/page-tabs";
import { RunsPage } from "./runs-page";

/** Headless runs and campaigns, and the scores of the diagnosers; without the right to start a run, the scores alone. */
export function Runs() {
  const teaches = useMay("teach");
  const tab = useView((s) => s.tab);
  const scores = { title: "Scores", body: <BenchmarkPage /> };
  const runs = { title: "Runs and campaigns", body: <RunsPage /> };
  return <PageTabs title="Runs" tabs={teaches ? { runs, scores } : { scores }} shown={tab} onShow={showTab} />;
}
