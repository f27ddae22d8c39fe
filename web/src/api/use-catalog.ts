import { useQuery } from "@tanstack/react-query";
import { useMemo } from "react";
import { api } from "./api";
import { controllersOf } from "./fits";
import { queryClient } from "./queries";
import type { BlockCard } from "./types";

const CATALOG = ["catalog"];
const NONE: BlockCard[] = [];
const FOR_EVER = { staleTime: Number.POSITIVE_INFINITY, gcTime: Number.POSITIVE_INFINITY };

const UNITS = ["units"];

/** The library's blocks and the units of the bench; a unit replaces the block of the library of the same name. */
function withUnits(blocks: BlockCard[], units: BlockCard[]): BlockCard[] {
  if (units.length === 0) return blocks;
  const own = new Set(units.map((unit) => `${unit.family}/${unit.name}`));
  return [...blocks.filter((block) => !own.has(`${block.family}/${block.name}`)), ...units];
}

/** Tell which units the bench on the page has beside the library's. */
export const setUnits = (units: BlockCard[] = NONE): void => void queryClient.setQueryData(UNITS, units);

const blocksNow = (): BlockCard[] =>
  withUnits(
    queryClient.getQueryData<BlockCard[]>(CATALOG) ?? NONE,
    queryClient.getQueryData<BlockCard[]>(UNITS) ?? NONE,
  );

/** The card of a block, as far as the catalogue has come. */
export const cardOf = (family: string, name: string): BlockCard | undefined =>
  blocksNow().find((b) => b.family === family && b.name === name);

/** The controllers in the same slot as a controller, in the order of the catalogue, as far as it has arrived. */
export function slotMates(controller: string, controllers: readonly string[]): string[] {
  const slot = cardOf("control", controller)?.slot ?? "";
  return controllersOf(slot, controllers, blocksNow()).map((b) => b.name);
}

/** Every block the server knows, asked for once, and the units of the bench. */
export function useCatalog() {
  const {
    data: library = NONE,
    isError,
    refetch,
  } = useQuery({
    queryKey: CATALOG,
    queryFn: api.catalog,
    ...FOR_EVER,
  });
  const { data: units } = useQuery({ queryKey: UNITS, queryFn: () => NONE, initialData: NONE, ...FOR_EVER });
  const blocks = useMemo(() => withUnits(library, units), [library, units]);
  return {
    blocks,
    failed: isError,
    retry: () => void refetch(),
    block: (family: string, name: string) => blocks.find((b) => b.family === family && b.name === name),
  };
}
