import { Checkbox } from "@mantine/core";
import type { PrintedMark } from "../../api/types";
import { placeIn, showPrinted, usePrinted } from "../../bench/printed";
import styles from "./scope.module.css";

/** What is printed of the signals of a scope, in words, and the switch that takes it out of the picture. */
export function PrintedLine({ marks }: { marks: PrintedMark[] }) {
  const isShown = usePrinted((s) => s.isShown);
  const said = [...new Set(marks.map((mark) => `“${mark.words}” (${placeIn(mark)})`))];
  return (
    <div className={`line ${styles.printed}`}>
      <Checkbox label="Printed" checked={isShown} onChange={(event) => showPrinted(event.currentTarget.checked)} />
      {isShown && <p title={said.join("\n")}>{said.join("; ")}</p>}
    </div>
  );
}
