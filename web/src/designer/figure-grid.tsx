import { Box, Popover, UnstyledButton } from "@mantine/core";
import type { Evaluation } from "../api/types";
import { EquationDetail } from "../ui/equation-detail";
import { formatChange, formatSi } from "../ui/format";
import { Formula } from "../ui/formula";
import styles from "./designer.module.css";

type Figure = Evaluation["figures"][number];

interface FigureGridProps {
  figures: Figure[];
  /** The figures of the device of the catalogue. */
  original: Figure[] | undefined;
  /** Whether the device has a drawing; without one, the beams of LCR-350 are used. */
  drawn: boolean;
}

/** The figures of a device: value, unit, equation, and the change since the catalogue. */
export function FigureGrid({ figures, original, drawn }: FigureGridProps) {
  return (
    <dl className={styles.grid}>
      {figures.map((figure) => (
        <Box key={figure.name} py={8}>
          <dt className={styles.name}>
            {figure.label}
            <Popover width={400} position="bottom">
              <Popover.Target>
                <UnstyledButton
                  className={styles.equation}
                  data-erratum={figure.equation.printed !== null}
                  aria-label={`${figure.label}: equation ${figure.equation.source}${figure.equation.printed ? ", erratum" : ""}`}
                >
                  {figure.equation.source}
                  {figure.equation.printed && " erratum"}
                </UnstyledButton>
              </Popover.Target>
              <Popover.Dropdown>
                {figure.equation.printed ? (
                  <EquationDetail equation={figure.equation} />
                ) : (
                  <Formula latex={figure.equation.latex} />
                )}
              </Popover.Dropdown>
            </Popover>
          </dt>
          <dd>
            <Box component="b" display="block" fz="lg" fw={620} style={{ whiteSpace: "nowrap" }}>
              {formatSi(figure.value, figure.unit)}
            </Box>
            <Box component="small" display="block" mih="1.4em">
              {!drawn && figure.name === "pull_in_v" ? "with the beams of LCR-350" : since(figure, original)}
            </Box>
          </dd>
        </Box>
      ))}
    </dl>
  );
}

function since({ name, value }: Figure, original: Figure[] | undefined): string {
  const before = original?.find((f) => f.name === name)?.value;
  if (!before) return "";
  const change = 100 * (value / before - 1);
  if (Math.abs(change) < 0.05) return "as in the catalogue";
  return formatChange(change, "%", 1);
}
