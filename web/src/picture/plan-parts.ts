import { type DeviceDrawing, type Rect, rectPath } from "./device-drawing";

/** A part of the device, as faults name the part that they are seen on. */
type Part = "plate" | "beams" | "trusses" | "fingers" | "film" | "drive" | "frame";

/** A part of a device from above, as a path in um. */
export interface PlanPart {
  path: string;
  look: "stator" | "shuttle" | "anchor" | "beam" | "driven" | "sensed";
  /** The names by which faults are seen on it. */
  names: readonly Part[];
  /** How it is drawn while the shuttle is away from its rest, um of the drawing; a part that stays has none. */
  follow?(x: number, y: number): string;
}

export const isFaulted = ({ names }: PlanPart, faulted: ReadonlySet<string>): boolean =>
  names.some((name) => faulted.has(name));

/** The parts of a comb resonator. */
export function resonatorParts(drawing: DeviceDrawing): PlanPart[] {
  const shuttle = (rects: readonly Rect[], names: readonly Part[]): PlanPart => ({
    path: rectPath(rects),
    look: "shuttle",
    names,
    follow: (x) => `translate(${x} 0)`,
  });
  return [
    { path: rectPath(drawing.stators), look: "stator", names: ["drive", "fingers"] },
    shuttle([...drawing.plate, ...drawing.arms], ["plate", "film"]),
    shuttle(drawing.rotor, ["fingers"]),
    { path: rectPath(drawing.anchors), look: "anchor", names: ["frame"] },
    ...beamGroups(drawing.beams).map(
      (group): PlanPart => ({
        path: rectPath(group.rects),
        look: "beam",
        names: ["beams"],
        follow: (x) => leaning(group, x),
      }),
    ),
    {
      path: rectPath(drawing.trusses),
      look: "beam",
      names: ["trusses"],
      follow: (x) => `translate(${x / 2} 0)`,
    },
  ];
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

const PLATE = 44;
const NEAR = 62;
const FAR = 76;
const REACH = 110;
const MARGIN = 14;

/** A gyroscope, not to scale: the drive frame moves along x, the sense frame along y, the plate along both. */
export const GYROSCOPE_PARTS: readonly PlanPart[] = [
  {
    path: `M${NEAR} ${-NEAR}H${FAR}V${NEAR}H${NEAR}ZM${-NEAR} ${-NEAR}H${-FAR}V${NEAR}H${-NEAR}Z`,
    look: "driven",
    names: [],
    follow: (x) => `translate(${x} 0)`,
  },
  {
    path: `M${-NEAR} ${NEAR}V${FAR}H${NEAR}V${NEAR}ZM${-NEAR} ${-NEAR}V${-FAR}H${NEAR}V${-NEAR}Z`,
    look: "sensed",
    names: [],
    follow: (_, y) => `translate(0 ${y})`,
  },
  {
    path: `M${-PLATE} ${-PLATE}H${PLATE}V${PLATE}H${-PLATE}Z`,
    look: "shuttle",
    names: ["plate"],
    follow: (x, y) => `translate(${x} ${y})`,
  },
];

/** The box of the picture of a gyroscope; motions are drawn for its width. */
export const GYROSCOPE_BOX: readonly number[] = [-REACH, -REACH, 2 * REACH, 2 * REACH];

/** The box of the picture of a comb resonator. */
export const boxAround = ({ width, height }: DeviceDrawing): readonly number[] => [
  -width / 2 - MARGIN,
  -height / 2 - MARGIN,
  width + 2 * MARGIN,
  height + 2 * MARGIN,
];
