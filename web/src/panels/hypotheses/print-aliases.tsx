import type { AliasReport } from "../../api/types";
import { drawnSvg } from "../../picture/drawn-svg";
import type { Picture } from "../../picture/picture";
import { pictureName } from "../../picture/picture-name";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import { AliasSweep } from "./alias-sweep";
import { Phasors } from "./phasors";

/** Which hypotheses coincide, as a picture. */
export function printAliases(report: AliasReport): Picture {
  return {
    ...pictureName("Motion of every hypothesis"),
    legend: report.map.responses.map(({ name }, i) => ({
      name,
      colour: traceColour(hypothesisStyle(i), "light"),
      mark: "dot",
    })),
    height: 420,
    paint(pen, { width, height }) {
      const size = { width: width / 2 - 20, height, isFramed: true };
      pen.add(drawnSvg(<Phasors report={report} {...size} scheme="light" />));
      pen.save();
      pen.translate(width / 2 + 20, 0);
      pen.add(drawnSvg(<AliasSweep report={report} {...size} />));
      pen.restore();
    },
  };
}
