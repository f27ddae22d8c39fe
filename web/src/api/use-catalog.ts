import { useQuery } from "@tanstack/react-query";
import { api } from "./api";
import { controllersOf } from "./fits";
import { queryClient } from "./queries";
import type { BlockCard } from "./types";

const CATALOG = ["catalog"];
const NONE: BlockCard[] = [];

const blocksNow = (): BlockCard[] => queryClient.getQueryData<BlockCard[]>(CATALOG) ?? NONE;

/** The card of a block, as far as the catalogue has come. */
export const cardOf = (family: string, name: string): BlockCard | undefined =>
  blocksNow().find((b) => b.family === family && b.name === name);

/** The controllers that stand in the slot of one of them, in the order of the catalogue, as far as it has come. */
export function slotMates(controller: string, controllers: readonly string[]): string[] {
  const slot = cardOf("control", controller)?.slot ?? "";
  return controllersOf(slot, controllers, blocksNow()).map((b) => b.name);
}

/** Every block the server knows; asked for once. */
export function useCatalog() {
  const {
    data: blocks = NONE,
    isError,
    refetch,
  } = useQuery({
    queryKey: CATALOG,
    queryFn: api.catalog,
    staleTime: Number.POSITIVE_INFINITY,
    gcTime: Number.POSITIVE_INFINITY,
  });
  return {
    blocks,
    failed: isError,
    retry: () => void refetch(),
    block: (family: string, name: string) => blocks.find((b) => b.family === family && b.name === name),
  };
}
