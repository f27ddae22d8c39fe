import { useEffect, useMemo, useRef, useState } from "react";
import { api } from "../api/api";
import { ApiError } from "../api/api-error";
import type { Bode, Evaluation } from "../api/types";
import { type DesignState, designDocument } from "./design";

interface Worked {
  evaluation: Evaluation;
  bode: Bode;
}

const SPAN = 10;

/**
 * What the server makes of a design: one request at a time, always the newest design next.
 *
 * While a value is refused the last good picture stays, with what is wrong beside it.
 */
export function useDesign(state: DesignState) {
  const [worked, setWorked] = useState<Worked | undefined>(undefined);
  const [refusal, setRefusal] = useState<ApiError | undefined>(undefined);
  const design = useMemo(() => designDocument(state), [state]);
  const wanted = useRef(design);
  const busy = useRef(false);

  useEffect(() => {
    wanted.current = design;
    if (busy.current) return;
    const work = async () => {
      busy.current = true;
      for (let asked: typeof design | undefined; asked !== wanted.current; ) {
        asked = wanted.current;
        try {
          const evaluation = await api.evaluate(asked);
          const f0 = evaluation.metrics.f0_hz;
          const bode = await api.bode({ ...asked, start_hz: f0 / SPAN, stop_hz: f0 * SPAN, points: 240, seed: 1 });
          setWorked({ evaluation, bode });
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
  }, [design]);

  return { ...worked, refusal, design };
}
