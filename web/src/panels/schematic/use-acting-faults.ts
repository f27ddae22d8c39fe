import { useCatalog } from "../../api/use-catalog";
import { useBench } from "../../stream/bench-store";

/** The faults that act on the bench now: their names, and the part each is seen on. */
export function useActingFaults(): { title: string; shows: string | null | undefined }[] {
  const faults = useBench((s) => s.bench?.faults) ?? [];
  const { block } = useCatalog();
  return faults
    .filter((fault) => fault.severity !== 0)
    .map(({ name }) => {
      const card = block("faults", name);
      return { title: card?.title ?? name.replaceAll("_", " "), shows: card?.shows };
    });
}
