import type { Claim, ClaimList } from "../../api/types";
import { placeIn } from "../../bench/printed";
import type { Pen } from "../../picture/pen";
import { SvgPen } from "../../picture/svg-pen";
import { paintRule } from "../../picture/traces";
import { capital } from "../../ui/capital";
import { formatNumber } from "../../ui/format";
import type { ScopeShown } from "../scope/paint-scope";
import { EDGE, HEIGHT, INK, paintFoot, paintTraces, WIDTH, wrapped, write } from "../scope/slide-page";
import { claimWords, stateWords } from "./claim-words";

const SIDE = 330;
const GOOD = "#0e7a4b";

/** One claim as a slide on light paper, its letters to be read from the last row. */
export function slideSvg(claim: Claim, list: ClaimList, shown: ScopeShown | undefined): string {
  const pen = new SvgPen();
  const words = claimWords(claim);
  const { title } = list;
  pen.textBaseline = "middle";
  write(pen, title, EDGE, 46, 34, 650, WIDTH - 2 * EDGE);
  const mark = claim.marks[0];
  const said = new Set(claim.marks.map((one) => one.words));
  const quoted = said.size === 1 || !claim.published ? (mark?.words ?? claim.published) : claim.published;
  const place = mark ? placeIn(mark) : list.source;
  pen.fillStyle = INK.muted;
  write(pen, capital(place), EDGE, 88, 20, 560, WIDTH - 2 * EDGE, INK.muted);
  let top = 122;
  for (const line of wrapped(pen, quoted ? `“${quoted}”` : list.claim, 26, WIDTH - 2 * EDGE).slice(0, 2)) {
    write(pen, line, EDGE, top, 26, 450, WIDTH - 2 * EDGE);
    top += 34;
  }
  const plot = { left: EDGE, top: top + 6, right: WIDTH - EDGE - SIDE, bottom: HEIGHT - 76 };
  if (shown) paintTraces(pen, shown, plot);
  else write(pen, "Nothing has run yet.", plot.left, (plot.top + plot.bottom) / 2, 24, 450, 600, INK.muted);

  const left = WIDTH - EDGE - SIDE + 34;
  const room = SIDE - 34;
  let y = plot.top + 50;
  paintMark(pen, claim.state, left + 26, y);
  wrapped(pen, stateWords(claim), 24, room - 76).forEach((line, i, all) => {
    write(pen, line, left + 72, y + (i - (all.length - 1) / 2) * 30, 24, 650, room - 72, inkOf(claim.state));
  });
  y += 74;
  const rows: [string, string, number][] = [
    ["printed", words.printed, 28],
    ["measured", words.measured, 36],
    ["expected", words.expected, 22],
  ];
  write(pen, words.name, left, y, 20, 600, room, INK.muted);
  y += 38;
  for (const [name, value, size] of rows) {
    write(pen, name, left, y, 18, 450, room, INK.muted);
    y += size * 0.5 + 20;
    for (const line of wrapped(pen, value, size, room)) {
      write(pen, line, left, y, size, 650, room);
      y += size * 1.2;
    }
    y += 12;
  }
  if (claim.verdict) write(pen, claim.verdict, left, y + 6, 24, 650, room, inkOf(claim.state));

  const ticks = formatNumber(list.tick, 0);
  paintFoot(pen, `CombBench ${list.version} · ${list.scenario_id} · seed ${list.seed} · ${ticks} ticks`);
  return pen.svg(WIDTH, HEIGHT, title);
}

const inkOf = (state: Claim["state"]) => (state === "holds" ? GOOD : state === "fails" ? INK.alarm : INK.muted);

/** A tick, a cross, or a circle for a claim that is not judged yet. */
function paintMark(pen: Pen, state: Claim["state"], x: number, y: number): void {
  const stroke = { colour: inkOf(state), width: 7 };
  if (state === "holds") {
    paintRule(pen, [x - 22, y + 2], [x - 6, y + 18], stroke);
    paintRule(pen, [x - 8, y + 18], [x + 24, y - 20], stroke);
  } else if (state === "fails") {
    paintRule(pen, [x - 18, y - 18], [x + 18, y + 18], stroke);
    paintRule(pen, [x - 18, y + 18], [x + 18, y - 18], stroke);
  } else {
    pen.strokeStyle = stroke.colour;
    pen.lineWidth = 5;
    pen.beginPath();
    pen.arc(x, y, 18, 0, 2 * Math.PI);
    pen.stroke();
  }
}
