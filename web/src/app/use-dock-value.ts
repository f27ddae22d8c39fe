import type { DockviewEvent } from "dockview-react";
import { useCallback, useSyncExternalStore } from "react";

/** A value of the dock, read again after each of its events. */
export function useDockValue<T>(event: DockviewEvent<unknown>, read: () => T): T {
  const subscribe = useCallback(
    (changed: () => void) => {
      const subscription = event(changed);
      return () => subscription.dispose();
    },
    [event],
  );
  return useSyncExternalStore(subscribe, read);
}
