import { useEffect, useState } from "react";
import { api } from "../../api/api";
import { usePanelVisible } from "../../api/panel-visible";
import type { UnstableRegion } from "../../api/types";
import { useBench } from "../../stream/bench-store";

/** Faults take effect a tick later, and sliders move in steps. */
const SETTLE_MS = 400;

/** The map of the unstable region of the bench as it is now; asked for again when its device, air or faults change. */
export function useUnstableRegion(driveV: number): { map: UnstableRegion | undefined; failed: string | undefined } {
  const id = useBench((s) => s.bench?.id);
  const visible = usePanelVisible();
  const now = useBench((s) => {
    const { device, plant, environment } = s.bench?.parameters ?? {};
    const faults = s.bench?.faults.map((f) => [f.name, f.severity]);
    return JSON.stringify([device, plant, environment, faults, (s.bench?.tick ?? 0) > 0]);
  });
  const [map, setMap] = useState<UnstableRegion | undefined>(undefined);
  const [failed, setFailed] = useState<string | undefined>(undefined);

  // biome-ignore lint/correctness/useExhaustiveDependencies: `now` says when the map is out of date
  useEffect(() => {
    if (!id || !visible) return;
    let current = true;
    const timer = setTimeout(() => {
      api.unstableRegion(id, driveV).then(
        (found) => {
          if (!current) return;
          setMap(found);
          setFailed(undefined);
        },
        (error: Error) => current && setFailed(error.message),
      );
    }, SETTLE_MS);
    return () => {
      current = false;
      clearTimeout(timer);
    };
  }, [id, visible, driveV, now]);
  return { map, failed };
}
