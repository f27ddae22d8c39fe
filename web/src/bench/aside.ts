import { lectures } from "../api/lectures";
import { useBench } from "../stream/bench-store";
import { openBench } from "./open-bench";
import { type PageName, setPage, useView } from "./view-store";

/** What a page goes back to after a lecture or a tour. */
export interface Before {
  bench: string | undefined;
  layout: string;
  page: PageName;
  ran: boolean;
}

/** Leave the bench for a while; it is paused if nobody else watches it. */
export async function stepAside(): Promise<Before> {
  const { bench } = useBench.getState();
  const ran = bench?.state === "running" && (bench.watchers ?? 0) <= 1;
  if (bench && ran) await lectures.command(bench.id, { kind: "pause" });
  const { layout, page } = useView.getState();
  return { bench: bench?.id, layout, page, ran };
}

/** Come back to it, as it ran and to the page that was shown. */
export async function stepBack({ bench, page, ran }: Before): Promise<void> {
  setPage(page);
  if (!bench) return;
  openBench(bench, true);
  if (ran) await lectures.command(bench, { kind: "start" });
}
