import { act } from "@testing-library/react";
import type { StateCreator, StoreApi } from "zustand";

const stores = new Set<Pick<StoreApi<unknown>, "getInitialState" | "setState">>();

type Create = typeof import("zustand")["create"];

/** Zustand's `create`, which remembers each store that a test loads. */
export const remembering = (create: Create): Create => {
  const make = (state: StateCreator<unknown>) => {
    const store = create(state);
    stores.add(store);
    return store;
  };
  return ((state?: StateCreator<unknown>) => (state ? make(state) : make)) as Create;
};

/** Put every store back to its initial state. */
export const resetStores = (): void =>
  act(() => {
    for (const store of stores) store.setState(store.getInitialState(), true);
  });
