import { Box, Popover, UnstyledButton } from "@mantine/core";
import type { Equation } from "../../api/types";
import { EquationDetail } from "../../ui/equation-detail";
import { Formula } from "../../ui/formula";

const ERRATUM = { p: "0 6px", bd: "1px solid var(--accent)", bdrs: 9, c: "var(--accent)", fz: "xs", lh: "16px" };

/** An equation with its number; where the printed one is wrong, a mark opens the printed form and the reason. */
export function BlockEquation({ equation }: { equation: Equation }) {
  return (
    <Box component="figure" p="4px 0">
      <Formula latex={equation.latex} />
      <figcaption className="row remark">
        {equation.label && <span>{equation.label.replaceAll("_", " ")}</span>}
        {equation.source && <span>({equation.source})</span>}
        {equation.printed && (
          <Popover width={360} position="bottom-end">
            <Popover.Target>
              <UnstyledButton {...ERRATUM} aria-label="Erratum: the printed equation differs">
                erratum
              </UnstyledButton>
            </Popover.Target>
            <Popover.Dropdown>
              <EquationDetail equation={equation} />
            </Popover.Dropdown>
          </Popover>
        )}
      </figcaption>
    </Box>
  );
}
