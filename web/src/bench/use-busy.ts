import { useState } from "react";
import { showError } from "./send";

type During<T> = (work: () => Promise<unknown>, what?: T) => Promise<void>;

/** Whether work is under way, or which of several, and how it begins; a refusal is shown. */
export function useBusy<T = true>(): [T | undefined, During<T>] {
  const [busy, setBusy] = useState<T | undefined>(undefined);
  const during: During<T> = (work, what = true as T) => {
    setBusy(what);
    return work()
      .then(() => undefined, showError)
      .finally(() => setBusy(undefined));
  };
  return [busy, during];
}
