import { useEffect, useMemo, useRef, useState } from "react";
import { api } from "../api/api";
import { ApiError } from "../api/client";
import type { Bode, Evaluation } from "../api/types";
import { type DesignState, designDocument } from "./design";

interface Worked {
  evaluation: Evaluation;
  /** None of a gyroscope, which is no one displacement over one voltage. */
  bode?: Bode;
  /** The drawing that the device was drawn from by the process; the device itself unless it was. */
  drawing?: Bode;
}

const SPAN = 10;

/**
 * The evaluation of a design by the server: one request at a time, always the newest design next.
 *
 * While a value is refused the last good picture stays, with the refusal.
 */
export function useDesign(state: DesignState) {
  const [worked, setWorked] = useState<Worked | undefined>(undefined);
  const [refusal, setRefusal] = useState<ApiError | undefined>(undefined);
  const design = useMemo(() => designDocument(state), [state]);
  const undrawn = useMemo(() => (state.drawn ? designDocument({ ...state, drawn: undefined }) : undefined), [state]);
  const before = useRef(undrawn);
  const wanted = useRef(design);
  const busy = useRef(false);

  useEffect(() => {
    wanted.current = design;
    before.current = undrawn;
    if (busy.current) return;
    const work = async () => {
      busy.current = true;
      for (let asked: typeof design | undefined; asked !== wanted.current; ) {
        asked = wanted.current;
        try {
          const evaluation = await api.evaluate(asked);
          if ("gyro.split_hz" in evaluation.metrics) {
            setWorked({ evaluation });
            setRefusal(undefined);
            continue;
          }
          const f0 = evaluation.metrics.f0_hz;
          const over = { start_hz: f0 / SPAN, stop_hz: f0 * SPAN, points: 240, seed: 1 };
          const bode = await api.bode({ ...asked, ...over });
          const drawing = before.current ? await api.bode({ ...before.current, ...over }) : bode;
          setWorked({ evaluation, bode, drawing });
          setRefusal(undefined);
        } catch (error) {
          if (!(error instanceof ApiError)) throw error;
          setRefusal(error);
        }
      }
    };
    void work().finally(() => {
      busy.current = false;
    });
  }, [design, undrawn]);

  return { ...worked, refusal, design };
}
