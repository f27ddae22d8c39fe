/** Places of the parts of the lanes, in CSS pixels. */
export interface LanesLayout {
  left: number;
  right: number;
  lanes: { top: number; height: number }[];
  winner: number;
  truth: number;
  delay: number;
  band: number;
  axis: number;
}

/** Below this height the names of the hypotheses would overlap. */
export const leastHeight = (lanes: number, fontSize: number): number => lanes * (fontSize + 2) + 4 * fontSize + 47;

export function lanesLayout(width: number, height: number, lanes: number, fontSize: number, left: number): LanesLayout {
  const band = fontSize + 6;
  const axisHeight = fontSize + 10;
  const bands = 3 * (band + 3) + 4;
  const room = Math.max(lanes * 8, height - axisHeight - bands - 6);
  const each = room / Math.max(1, lanes);
  const winner = 4 + room + 4;
  return {
    left,
    right: width - fontSize * 6.2,
    lanes: Array.from({ length: lanes }, (_, i) => ({ top: 4 + i * each, height: each })),
    winner,
    truth: winner + band + 3,
    delay: winner + 2 * (band + 3),
    band,
    axis: winner + 3 * (band + 3),
  };
}
