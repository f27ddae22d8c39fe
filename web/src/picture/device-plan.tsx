import { type Ref, useImperativeHandle, useRef } from "react";
import { type DeviceDrawing, type Rect, rectPath } from "./device-drawing";
import styles from "./device-plan.module.css";

/** A part of the device, as faults name the part that they are seen on. */
export type Part = "plate" | "beams" | "trusses" | "fingers" | "film" | "drive" | "frame";

/** Moves the drawn shuttle from where it rests, in um of the drawing. */
export interface Moving {
  move(um: number): void;
}

interface DevicePlanProps {
  drawing: DeviceDrawing;
  /** Parts on which a fault acts. */
  faulted?: ReadonlySet<string>;
  moving?: Ref<Moving>;
}

const NONE: ReadonlySet<string> = new Set();

/** The device from above, as parts of an SVG picture in um. */
export function DevicePlan({ drawing, faulted = NONE, moving }: DevicePlanProps) {
  const shuttle = useRef<SVGGElement>(null);
  const trusses = useRef<SVGPathElement>(null);
  const beams = useRef<(SVGPathElement | null)[]>([]);
  const groups = beamGroups(drawing.beams);
  useImperativeHandle(moving, () => ({
    move: (um) => {
      shuttle.current?.setAttribute("transform", `translate(${um} 0)`);
      trusses.current?.setAttribute("transform", `translate(${um / 2} 0)`);
      groups.forEach((group, i) => {
        beams.current[i]?.setAttribute("transform", leaning(group, um));
      });
    },
  }));
  const acts = (...parts: Part[]) => parts.some((part) => faulted.has(part)) || undefined;
  return (
    <>
      <path d={rectPath(drawing.stators)} className={styles.stator} data-fault={acts("drive", "fingers")} />
      <g ref={shuttle}>
        <path
          d={rectPath([...drawing.plate, ...drawing.arms])}
          className={styles.shuttle}
          data-fault={acts("plate", "film")}
        />
        <path d={rectPath(drawing.rotor)} className={styles.shuttle} data-fault={acts("fingers")} />
      </g>
      <path d={rectPath(drawing.anchors)} className={styles.anchor} data-fault={acts("frame")} />
      {groups.map(({ rects }, i) => (
        <path
          // biome-ignore lint/suspicious/noArrayIndexKey: the groups of a folded flexure are always these four
          key={i}
          ref={(path) => {
            beams.current[i] = path;
          }}
          d={rectPath(rects)}
          className={styles.beam}
          data-fault={acts("beams")}
        />
      ))}
      <path ref={trusses} d={rectPath(drawing.trusses)} className={styles.beam} data-fault={acts("trusses")} />
    </>
  );
}

interface BeamGroup {
  rects: Rect[];
  /** 1 above the plate, -1 below it. */
  side: number;
  /** Whether the roots are on the plate and move with it; else they are on an anchor. */
  onPlate: boolean;
}

/** The beams by side, and by where their roots are: the outer two of each side on the plate, the inner two anchored. */
function beamGroups(beams: readonly Rect[]): BeamGroup[] {
  const farthest = Math.max(...beams.map(middle).map(Math.abs));
  return [1, -1].flatMap((side) =>
    [true, false].map((onPlate) => ({
      side,
      onPlate,
      rects: beams.filter((beam) => Math.sign(beam.y) === side && onPlate === Math.abs(middle(beam)) > 0.67 * farthest),
    })),
  );
}

const middle = ({ x, width }: Rect): number => x + width / 2;

/** Beams lean from their roots to the truss, which goes half as far as the plate. */
function leaning({ rects, side, onPlate }: BeamGroup, um: number): string {
  const [{ y, height }] = rects;
  const root = onPlate ? um : 0;
  const slope = (side * (um / 2 - root)) / height;
  const rootY = side > 0 ? y : y + height;
  return `matrix(1 0 ${slope} 1 ${root - slope * rootY} 0)`;
}
