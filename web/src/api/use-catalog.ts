import { useEffect } from "react";
import { create } from "zustand";
import { api } from "./api";
import { controllersOf } from "./fits";
import type { BlockCard } from "./types";

const useStore = create<{ blocks: BlockCard[]; failed: boolean }>(() => ({ blocks: [], failed: false }));
let asked: Promise<void> | undefined;

function ask(): void {
  if (asked) return;
  asked = api.catalog().then(
    (blocks) => useStore.setState({ blocks, failed: false }),
    () => {
      asked = undefined;
      useStore.setState({ failed: true });
    },
  );
}

/** The card of a block, as far as the catalogue has come. */
export const cardOf = (family: string, name: string): BlockCard | undefined =>
  useStore.getState().blocks.find((b) => b.family === family && b.name === name);

/** The controllers that stand in the slot of one of them, in the order of the catalogue, as far as it has come. */
export function slotMates(controller: string, controllers: readonly string[]): string[] {
  const slot = cardOf("control", controller)?.slot ?? "";
  return controllersOf(slot, controllers, useStore.getState().blocks).map((b) => b.name);
}

/** Every block the server knows; asked for once. */
export function useCatalog() {
  const { blocks, failed } = useStore();
  useEffect(ask, []);
  return {
    blocks,
    failed,
    retry: ask,
    block: (family: string, name: string) => blocks.find((b) => b.family === family && b.name === name),
  };
}
