import { Group, NativeSelect, SegmentedControl } from "@mantine/core";
import { useMemo, useRef, useState } from "react";
import { PictureMenu } from "../../picture/picture-menu";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { TIME_WINDOWS_MS, windowItems } from "../../ui/time-axis";
import styles from "../phase/phase.module.css";
import { LocusPlot, type Mass } from "./locus-plot";
import { type LocusShown, locusPicture } from "./paint-locus";

const MASS: Mass = { name: "Mass", x: "plant.x", y: "plant.y" };
const PARTNER: Mass = { name: "Partner", x: "plant.partner_x", y: "plant.partner_y" };

/** The meaning of the path, by the controller along y. */
const WORDS: Record<string, string> = {
  open_loop_rate:
    "A spring between the axes tilts the line: that is the quadrature. A turning frame opens it to an ellipse, wider with the rate.",
  force_to_rebalance: "The controller keeps y at zero. The force it needs for this is the rate.",
  whole_angle: "The line of oscillation turns back by the angle that the frame has turned.",
};

/** The path of the mass in its plane, with the tilt of its long axis; and the path of a partner. */
export function LocusPanel() {
  const axes = useBench((s) => s.bench?.axes);
  const meaning = useBench((s) => WORDS[s.bench?.controller ?? ""]);
  const [windowMs, setWindowMs] = useState(2);
  const [stretched, setStretched] = useState(true);
  const painted = useRef<LocusShown | undefined>(undefined);
  const masses = useMemo(() => (axes?.includes("partner_x") ? [MASS, PARTNER] : [MASS]), [axes]);
  if (!axes) return <EmptyState title="No bench yet">The path of the mass appears with the bench.</EmptyState>;
  return (
    <section className={`view ${styles.panel}`} aria-label="Motion">
      <Group gap="6px 8px" p="6px 12px">
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
        <PictureMenu take={() => painted.current && locusPicture(painted.current)} />
      </Group>
      <LocusPlot masses={masses} windowMs={windowMs} stretched={stretched} painted={painted} meaning={meaning} />
    </section>
  );
}
