import { useMemo } from "react";
import { useShallow } from "zustand/react/shallow";
import { useBench } from "../../stream/bench-store";
import { type Instance, instances } from "./instances";

/** Every block of the bench shown; the same list until one of them changes. */
export function useInstances(): Instance[] {
  const bench = useBench(
    useShallow(({ bench }) =>
      bench
        ? {
            axes: bench.axes,
            parameters: bench.parameters,
            controller: bench.controller,
            controllers: bench.controllers,
            diagnosers: bench.diagnosers,
          }
        : undefined,
    ),
  );
  const slots = useBench(useShallow((s) => s.bench?.slots));
  return useMemo(() => (bench && slots ? instances({ ...bench, slots }) : []), [bench, slots]);
}
