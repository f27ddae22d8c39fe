import { useComputedColorScheme } from "@mantine/core";
import type { Scheme } from "./palette";

/** The colour scheme in force. */
export const useScheme = (): Scheme => useComputedColorScheme("dark", { getInitialValueInEffect: false });
