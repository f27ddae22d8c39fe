import { useBench } from "../stream/bench-store";

/** A name for a file. */
export const fileStem = (name: string) =>
  name
    .toLowerCase()
    .replaceAll(/[^a-z0-9]+/g, "-")
    .replaceAll(/^-|-$/g, "");

/** The title and the file name of a picture of the bench that is connected. */
export function pictureName(what: string): { title: string; stem: string } {
  const bench = useBench.getState().bench;
  const stem = fileStem(`${bench?.scenario_id ?? "bench"}-${what}`);
  return { title: bench ? `${what} · ${bench.title}` : what, stem };
}
