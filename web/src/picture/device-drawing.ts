import { roundTo } from "../ui/unit-scale";

/** A rectangle from corner to corner, um; x is the direction of the drive. */
export interface Rect {
  x: number;
  y: number;
  width: number;
  height: number;
}

export interface DeviceDrawing {
  plate: Rect[];
  arms: Rect[];
  rotor: Rect[];
  stators: Rect[];
  beams: Rect[];
  trusses: Rect[];
  anchors: Rect[];
  width: number;
  height: number;
}

const STATOR_BAR = 18;
const ANCHOR_INSET = 5;
const NOTCH_SHARE = 0.33;

const around = (x: number, y: number, width: number, height: number): Rect => ({
  x: x - width / 2,
  y: y - height / 2,
  width,
  height,
});

/** Every part of a folded-flexure comb resonator where its drawing has it, as etched. */
export function deviceDrawing(g: Record<string, number>): DeviceDrawing {
  const beam = g.beam_width_um - 2 * g.beam_bias_um;
  const truss = g.truss_width_um - 2 * g.beam_bias_um;
  const finger = g.finger_width_um - 2 * g.comb_bias_um;
  const pitch = 2 * (g.finger_width_um + g.finger_gap_um);
  const root = g.plate_width_um / 2;
  const segment = g.truss_segment_um;
  const armRoot = g.plate_length_um / 2;
  const armEnd = armRoot + g.arm_width_um;
  const notchWidth = Math.min(segment + 34, 3 * segment - 8, g.plate_length_um - 8);
  const notchDepth = NOTCH_SHARE * g.plate_width_um;
  const drawing: DeviceDrawing = {
    plate: [],
    arms: [],
    rotor: [],
    stators: [],
    beams: [],
    trusses: [],
    anchors: [],
    width: 2 * (armEnd + 2 * g.finger_length_um - g.overlap_um + STATOR_BAR),
    height: Math.max(2 * (root + g.beam_length_um + truss), g.arm_length_um, g.fingers * pitch) + 8,
  };

  drawing.plate.push(around(0, 0, g.plate_length_um, g.plate_width_um - 2 * notchDepth));
  for (const side of [1, -1]) {
    const wing = (g.plate_length_um - notchWidth) / 2;
    for (const end of [1, -1])
      drawing.plate.push(around((end * (notchWidth + wing)) / 2, side * (root - notchDepth / 2), wing, notchDepth));
    drawing.anchors.push(
      around(
        0,
        side * (root - notchDepth / 2 + ANCHOR_INSET / 2),
        notchWidth - 2 * ANCHOR_INSET,
        notchDepth - ANCHOR_INSET,
      ),
    );
    for (const place of [-1.5, -0.5, 0.5, 1.5])
      drawing.beams.push(around(place * segment, side * (root + g.beam_length_um / 2), beam, g.beam_length_um));
    drawing.trusses.push(around(0, side * (root + g.beam_length_um + truss / 2), 3 * segment + beam, truss));
  }
  for (const end of [1, -1]) {
    drawing.arms.push(around(end * (armRoot + g.arm_width_um / 2), 0, g.arm_width_um, g.arm_length_um));
    const statorRoot = armEnd + 2 * g.finger_length_um - g.overlap_um;
    drawing.stators.push(around(end * (statorRoot + STATOR_BAR / 2), 0, STATOR_BAR, (g.fingers + 1) * pitch));
    for (let i = 0; i < g.fingers; i += 1) {
      const y = (i - (g.fingers - 1) / 2) * pitch;
      drawing.rotor.push(around(end * (armEnd + g.finger_length_um / 2), y, g.finger_length_um, finger));
    }
    for (let i = 0; i <= g.fingers; i += 1) {
      const y = (i - g.fingers / 2) * pitch;
      drawing.stators.push(around(end * (statorRoot - g.finger_length_um / 2), y, g.finger_length_um, finger));
    }
  }
  return drawing;
}

/** Many rectangles as one path. */
export function rectPath(rects: readonly Rect[]): string {
  return rects
    .map(({ x, y, width, height }) => `M${fix(x)} ${fix(y)}h${fix(width)}v${fix(height)}h${fix(-width)}z`)
    .join("");
}

const fix = (value: number) => roundTo(value, 7);
