import { useEffect, useState } from "react";
import { useBench } from "../../stream/bench-store";

const SHOWN_MS = 8000;

/** Whether the server said a moment ago that this page takes frames too slowly. */
export function useSlowPage(): boolean {
  const notice = useBench((s) => (s.notice?.code === "slow_client" ? s.notice : undefined));
  const [slow, setSlow] = useState(false);
  useEffect(() => {
    if (!notice) return;
    setSlow(true);
    const timer = setTimeout(() => setSlow(false), SHOWN_MS);
    return () => clearTimeout(timer);
  }, [notice]);
  return slow;
}
