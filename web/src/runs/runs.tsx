import { useMay } from "../api/me";
import type { PageName } from "../bench/places";
import { setPage, useView } from "../bench/view-store";
import { BenchmarkPage } from "../benchmark/benchmark-page";
import { PageTabs } from "../ui/page-tabs";
import { RunsPage } from "./runs-page";

/** Headless runs and campaigns, and the scores of the diagnosers; without the right to start a run, the scores alone. */
export function Runs() {
  const teaches = useMay("teach");
  const page = useView((s) => s.page);
  const benchmark = { title: "Scores", body: <BenchmarkPage /> };
  const runs = { title: "Runs and campaigns", body: <RunsPage /> };
  const tabs: Record<string, typeof runs> = teaches ? { runs, benchmark } : { benchmark };
  return <PageTabs title="Runs" tabs={tabs} shown={page} onShow={(tab) => setPage(tab as PageName)} />;
}
