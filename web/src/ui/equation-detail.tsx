import { Box, Stack } from "@mantine/core";
import type { ReactNode } from "react";
import type { Equation } from "../api/types";
import { Formula } from "./formula";
import { Prose } from "./prose";

/** An erratum: the printed equation, the working one, and the reason. */
export function EquationDetail({ equation }: { equation: Equation }) {
  return (
    <Stack gap={8}>
      <Part name="As printed">
        <Printed text={equation.printed ?? ""} />
      </Part>
      <Part name="As it works">
        <Formula latex={equation.latex} />
      </Part>
      {equation.why && (
        <Part name="Why">
          <Words text={equation.why} />
        </Part>
      )}
    </Stack>
  );
}

function Part({ name, children }: { name: string; children: ReactNode }) {
  return (
    <div>
      <Box component="h3" mb={2} c="dimmed" fz="xs">
        {name}
      </Box>
      {children}
    </div>
  );
}

const Words = ({ text }: { text: string }) => (
  <Box component="p" fz="sm">
    <Prose text={text} />
  </Box>
);

/** The printed text is an equation, or words about an equation. */
const Printed = ({ text }: { text: string }) =>
  /[\\^_=]/.test(text) ? <Formula latex={text} /> : <Words text={text} />;
