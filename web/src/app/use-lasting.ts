import { useEffect, useState } from "react";

/** Whether something has been so for a while: keeps what is over in a blink from blinking. */
export function useLasting(now: boolean, forMs: number): boolean {
  const [lasting, setLasting] = useState(false);
  useEffect(() => {
    if (!now) return setLasting(false);
    const timer = setTimeout(() => setLasting(true), forMs);
    return () => clearTimeout(timer);
  }, [now, forMs]);
  return lasting;
}
