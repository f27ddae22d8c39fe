import { NativeSelect, SegmentedControl } from "@mantine/core";
import { useMemo, useRef, useState } from "react";
import { PictureMenu, type TakePicture } from "../../picture/picture-menu";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { TIME_WINDOWS_MS, windowItems } from "../../ui/time-axis";
import styles from "../phase/phase.module.css";
import { LocusPlot, type Mass } from "./locus-plot";

const MASS: Mass = { name: "Mass", x: "plant.x", y: "plant.y" };
const PARTNER: Mass = { name: "Partner", x: "plant.partner_x", y: "plant.partner_y" };

/** What the path tells, by the controller that drives along y. */
const WORDS: Record<string, string> = {
  open_loop_rate:
    "A spring between the axes tilts the line: that is the quadrature. A turning frame opens it to an ellipse, wider with the rate.",
  force_to_rebalance: "The controller holds y at rest. The force it needs for this is the rate.",
  whole_angle: "The line of oscillation turns back by the angle that the frame has turned.",
};

/** The path of the mass in the plane it moves in, with the tilt of its long axis; that of a partner beside it. */
export function LocusPanel() {
  const axes = useBench((s) => s.bench?.axes);
  const words = useBench((s) => WORDS[s.bench?.controller ?? ""]);
  const [windowMs, setWindowMs] = useState(2);
  const [stretched, setStretched] = useState(true);
  const picture = useRef<TakePicture>(null);
  const masses = useMemo(() => (axes?.includes("partner_x") ? [MASS, PARTNER] : [MASS]), [axes]);
  if (!axes) return <EmptyState title="No bench yet">The path of the mass appears with the bench.</EmptyState>;
  return (
    <section className={`view ${styles.panel}`} aria-label="Motion">
      <div className={`row ${styles.bar}`}>
        <NativeSelect
          w={84}
          aria-label="Length of the path"
          value={String(windowMs)}
          data={windowItems(TIME_WINDOWS_MS.phase, windowMs)}
          onChange={(e) => setWindowMs(Number(e.currentTarget.value))}
        />
        <SegmentedControl
          aria-label="Scale of y"
          value={stretched ? "own" : "same"}
          data={[
            { value: "same", label: "x and y alike" },
            { value: "own", label: "y stretched" },
          ]}
          onChange={(value) => setStretched(value === "own")}
        />
        <PictureMenu take={() => picture.current?.()} />
      </div>
      <LocusPlot masses={masses} windowMs={windowMs} stretched={stretched} picture={picture} />
      {words && <p className={styles.words}>{words}</p>}
    </section>
  );
}
