/** A box of a loop as drawn. */
export interface DrawnBox {
  id: string;
  title: string;
  x: number;
  y: number;
  /** What stands in it now. */
  kind: string;
  /** The card it opens. */
  card: string | undefined;
  /** A value in words, where no signal tells it. */
  says?: string;
  faulty: boolean;
  /** Something else does its work. */
  waits?: boolean;
}

/** A signal path between boxes. */
export interface Wire {
  id: string;
  d: string;
  label: string;
  at: [number, number];
}

/** Letters are drawn at least at 0.88 of their size: below that the drawing scrolls. */
export const DRAWING = { width: 348, height: 226 };

export const BOX = { width: 104, height: 56 };
