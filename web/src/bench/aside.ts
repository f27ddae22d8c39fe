import { api } from "../api/api";
import { useBench } from "../stream/bench-store";
import { openBench } from "./open-bench";
import type { Place } from "./places";
import { openPlace, useView } from "./view-store";

/** The state to which a page returns after a lecture or a tour. */
export interface Before {
  bench: string | undefined;
  layout: string;
  place: Place;
  ran: boolean;
}

/** Leave the bench for a while; it pauses if no other page watches it. */
export async function stepAside(): Promise<Before> {
  const { bench } = useBench.getState();
  const ran = bench?.state === "running" && (bench.watchers ?? 0) <= 1;
  if (bench && ran) await api.command(bench.id, { kind: "pause" });
  const { layout, page, item } = useView.getState();
  return { bench: bench?.id, layout, place: { page, item }, ran };
}

/** Come back to it, as it ran and to the place that was shown. */
export async function stepBack({ bench, place, ran }: Before): Promise<void> {
  openPlace(place.page, place.item);
  if (!bench) return;
  openBench(bench, true);
  if (ran) await api.command(bench, { kind: "start" });
}
