import { Box, type BoxProps } from "@mantine/core";
import type { ReactNode } from "react";
import styles from "./ui.module.css";

/** The state of a bench: a word after a mark of its own shape and colour. */
export function StateDot({ state, children, ...rest }: BoxProps & { state: string; children: ReactNode }) {
  return (
    <Box component="span" className={styles.state} data-state={state} {...rest}>
      <i aria-hidden="true" />
      {children}
    </Box>
  );
}
