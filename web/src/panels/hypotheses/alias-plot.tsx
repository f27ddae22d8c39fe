import type { AliasReport } from "../../api/types";
import { PictureMenu } from "../../picture/picture-menu";
import { useScheme } from "../../ui/use-scheme";
import { useSize } from "../../ui/use-size";
import { AliasSweep } from "./alias-sweep";
import styles from "./hypotheses.module.css";
import { Phasors } from "./phasors";
import { printAliases } from "./print-aliases";

const HEIGHT = 230;
/** The motion of every hypothesis at the drive, as a point: those that lie together cannot be told apart. */
export function AliasPlot({ report }: { report: AliasReport }) {
  const scheme = useScheme();
  const { element, size } = useSize<HTMLDivElement>();
  const split = size.width > 520;
  const width = split ? size.width / 2 : size.width;
  return (
    <div ref={element} className={styles.plots}>
      {size.width > 120 && (
        <>
          <div className={styles.export}>
            <PictureMenu take={() => printAliases(report)} />
          </div>
          <Phasors report={report} width={width} height={HEIGHT} scheme={scheme} />
          <AliasSweep report={report} width={split ? size.width - width : size.width} height={HEIGHT} />
        </>
      )}
    </div>
  );
}
