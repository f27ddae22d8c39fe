import { queryClient } from "../api/queries";
import type { Bench, BlockCard } from "../api/types";
import { type BenchStore, useBench } from "../stream/bench-store";
import type { FileBench } from "./file-bench";

/** Give the painters of the page the titles of blocks and the hypotheses, by which they name events and lanes. */
export function teachWords({ diagnosers, signals, document: { faults, controllers } }: FileBench): void {
  const cards = [
    ...Object.entries(faults).map(([name, { title, suggested, unit, minimum, maximum }]) => {
      const severity = { name: "severity", unit, minimum, maximum };
      return { family: "faults", name, title, suggested, parameters: [severity] };
    }),
    ...Object.entries(controllers).map(([name, title]) => ({ family: "control", name, title, parameters: [] })),
  ];
  queryClient.setQueryData(["catalog"], cards as unknown as BlockCard[]);
  useBench.setState({ bench: { diagnosers, signals } as unknown as Bench } satisfies Partial<BenchStore>);
}
