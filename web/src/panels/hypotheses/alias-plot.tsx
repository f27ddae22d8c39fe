import { Box as Part } from "@mantine/core";
import { useMemo } from "react";
import type { AliasReport } from "../../api/types";
import { Painted } from "../../picture/painted";
import type { Box, Look, Pen } from "../../picture/pen";
import { PictureMenu } from "../../picture/picture-menu";
import styles from "./hypotheses.module.css";
import { aliasPicture, paintAliasSweep, paintPhasors } from "./paint-aliases";

/** The motion of every hypothesis at the drive, as a point: hypotheses at one point cannot be separated. */
export function AliasPlot({ report }: { report: AliasReport }) {
  const [phasors, sweep] = useMemo(
    () =>
      [paintPhasors, paintAliasSweep].map((paint) => (pen: Pen, box: Box, look: Look) => paint(pen, box, report, look)),
    [report],
  );
  return (
    <div className={styles.plots}>
      <Part pos="absolute" top={-30} right={0}>
        <PictureMenu take={() => aliasPicture(report)} />
      </Part>
      <Painted label="Motion of every hypothesis at the drive frequency, in the complex plane" paint={phasors} />
      <Painted label="Distance of the closest pair over the drive frequency" paint={sweep} />
    </div>
  );
}
