import { useEffect } from "react";
import { create } from "zustand";
import { api } from "./api";
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
