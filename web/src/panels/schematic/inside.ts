import { Graph, layout } from "@dagrejs/dagre";
import type { BlockCard, Signal } from "../../api/types";

/** A value on a line: its name on the drawing, and its signals, if it has any. */
interface Quantity {
  name: string;
  signals: { label: string; name: string }[];
  /** Number of signals without room. */
  more: number;
}

export interface Place {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** The inside of a block, laid out: stages, the quantities between them, and the lines that join both. */
export interface Inside {
  width: number;
  height: number;
  stages: (Place & { title: string; stage: number })[];
  quantities: (Place & Quantity)[];
  lines: { id: string; d: string; enters: boolean }[];
}

const LETTER = 6.3;
const ROW = 15;
const STAGE_HEIGHT = 30;
/** Letters of a number with its unit. */
const VALUE = 8;
const MOST_ROWS = 6;

type Slots = Record<string, string>;

/** The beginning of the names of the signals of a port: the source of an input, or the block itself. */
function sourceOf(name: string, key: string, block: BlockCard, slots: Slots): string {
  const source = block.inputs.find((port) => port.name === name)?.source;
  if (source === undefined) return `${key}.${name}`;
  const [, slot, port] = /^@(\w+)\.(\w+)$/.exec(source) ?? [];
  return slot ? `${slots[slot] ?? slot}.${port}` : source.replace(/\?$/, "");
}

/** The quantity behind a name of a stage. */
export function quantityOf(
  name: string,
  key: string,
  block: BlockCard,
  slots: Slots,
  signals: readonly Signal[],
): Quantity {
  const source = sourceOf(name, key, block, slots);
  const found = signals
    .filter((signal) => signal.name === source || signal.name.startsWith(`${source}.`))
    .map((signal) => ({ label: signal.name.slice(source.length + 1), name: signal.name }));
  return {
    name: name.replaceAll("_", " "),
    signals: found.slice(0, MOST_ROWS),
    more: Math.max(0, found.length - MOST_ROWS),
  };
}

/** Rows of a quantity: its name, a row for each signal, and a row for the signals without room. */
const rowsOf = ({ signals, more }: Quantity): number => 1 + signals.length + (more > 0 ? 1 : 0);

function widthOf({ name, signals }: Quantity): number {
  const letters = signals.map(({ label }) => label.length + (label ? 1 : 0) + VALUE);
  return LETTER * Math.max(name.length, ...letters) + 8;
}

/** Lay the inside of a block out, from its inputs at the top to its outputs at the bottom. */
export function insideOf(block: BlockCard, quantity: (name: string) => Quantity): Inside {
  const graph = new Graph();
  graph.setGraph({ rankdir: "TB", nodesep: 10, ranksep: 14, marginx: 4, marginy: 4 });
  graph.setDefaultEdgeLabel(() => ({}));
  const quantities = new Map<string, Quantity>();
  const add = (name: string) => {
    if (quantities.has(name)) return;
    const found = quantity(name);
    quantities.set(name, found);
    graph.setNode(`of ${name}`, { width: widthOf(found), height: ROW * rowsOf(found) + 4 });
  };
  block.structure.forEach(({ title, takes, gives }, stage) => {
    graph.setNode(`stage ${stage}`, { width: LETTER * title.length + 24, height: STAGE_HEIGHT });
    for (const name of [...takes, ...gives]) add(name);
    for (const name of takes) graph.setEdge(`of ${name}`, `stage ${stage}`);
    for (const name of gives) graph.setEdge(`stage ${stage}`, `of ${name}`);
  });
  layout(graph);
  const place = (id: string): Place => {
    const { x, y, width, height } = graph.node(id) as Place;
    return { x: x - width / 2, y: y - height / 2, width, height };
  };
  const { width = 0, height = 0 } = graph.graph() as Partial<Place>;
  const isEmpty = block.structure.length === 0; // a graph of nothing has no finite size
  return {
    width: isEmpty ? 0 : width,
    height: isEmpty ? 0 : height,
    stages: block.structure.map(({ title }, stage) => ({ title, stage, ...place(`stage ${stage}`) })),
    quantities: [...quantities].map(([name, found]) => ({ ...found, ...place(`of ${name}`) })),
    lines: graph.edges().map(({ v, w }) => ({
      id: `${v} ${w}`,
      d: curve((graph.edge(v, w) as { points: Point[] }).points),
      enters: w.startsWith("stage"),
    })),
  };
}

interface Point {
  x: number;
  y: number;
}

/** A smooth line through the middles of a polyline, from its beginning to its end. */
function curve(points: Point[]): string {
  const [first, ...rest] = points;
  const last = points[points.length - 1];
  const bends = rest.slice(0, -1).map((at, i) => {
    const next = rest[i + 1];
    return `Q${at.x} ${at.y} ${(at.x + next.x) / 2} ${(at.y + next.y) / 2}`;
  });
  return `M${first.x} ${first.y}${bends.join("")}L${last.x} ${last.y}`;
}
