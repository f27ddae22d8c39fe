import { useDebouncedValue } from "@mantine/hooks";
import { useMemo } from "react";
import { api } from "../../api/api";
import { usePanelVisible } from "../../api/panel-visible";
import { useAsked } from "../../api/queries";
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
  const question = useMemo(() => ({ id, driveV, now }), [id, driveV, now]);
  const [settled] = useDebouncedValue(question, SETTLE_MS);
  const { answer, refusal } = useAsked(settled.id && visible ? ["unstable region", settled] : undefined, () =>
    api.unstableRegion(settled.id ?? "", settled.driveV),
  );
  return { map: answer, failed: refusal?.body.message };
}
