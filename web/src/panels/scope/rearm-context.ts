import { createContext } from "react";

/** Arms a single sweep of the scope around once more. */
export const RearmContext = createContext<() => void>(() => undefined);
