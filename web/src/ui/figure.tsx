import { Box, type BoxProps } from "@mantine/core";
import type { ReactNode } from "react";

interface FigureProps extends BoxProps {
  name: ReactNode;
  /** An explanation of the name. */
  title?: string;
  children: ReactNode;
}

/** A figure under its name, in a list of definitions. */
export function Figure({ name, title, children, ...look }: FigureProps) {
  return (
    <div>
      <dt title={title}>{name}</dt>
      <Box component="dd" {...look}>
        {children}
      </Box>
    </div>
  );
}
