import { useCallback, useRef, useState } from "react";

/**
 * A state that is set in every frame and seldom changes, compared by its text.
 *
 * React keeps every call that changes nothing until the next that does, so such calls are left out.
 */
export function useChanged<T>(first: T): [T, (next: T) => void] {
  const [value, setValue] = useState(first);
  const known = useRef(JSON.stringify(first));
  const set = useCallback((next: T) => {
    const text = JSON.stringify(next);
    if (text === known.current) return;
    known.current = text;
    setValue(next);
  }, []);
  return [value, set];
}
