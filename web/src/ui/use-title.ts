import { useDocumentTitle } from "@mantine/hooks";

/** Set the title of the window: the parts from the smallest to the page. */
export const useTitle = (...parts: (string | undefined)[]): void =>
  useDocumentTitle([...parts.filter(Boolean), "CombBench"].join(" | "));
