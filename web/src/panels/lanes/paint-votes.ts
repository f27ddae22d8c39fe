import type { Box, Look, Pen } from "../../picture/pen";
import { within } from "../../picture/traces";
import { formatCount } from "../../ui/format";
import { CANVAS, fontFor } from "../../ui/palette";
import { placesOf } from "./paint-bands";
import { type LanesShown, layoutOf } from "./paint-lanes";
import type { Votes } from "./use-revealed";

/** Share of the field that the longest bar takes. */
const LONGEST = 0.45;

/** Paint the predictions over the lanes: a bar for each lane, and a mark at each guessed moment. */
export function paintVotes(ctx: Pen, box: Box, shown: LanesShown, look: Look, votes: Votes): void {
  const { scheme, fontSize } = look;
  const layout = layoutOf(box, shown, look);
  const colours = CANVAS[scheme];
  const { x } = placesOf({ ...shown, ...look, layout });
  const most = Math.max(1, ...votes.counts);
  const width = LONGEST * (layout.right - layout.left);
  within(ctx, { left: layout.left, right: layout.right, top: 0, bottom: layout.axis }, () => {
    votes.counts.forEach((count, i) => {
      if (count === 0 || !layout.lanes[i]) return;
      const { top, height } = layout.lanes[i];
      const tall = Math.min(height - 4, fontSize * 1.5);
      const bar = { left: layout.left + 2, top: top + (height - tall) / 2, width: (width * count) / most };
      ctx.fillStyle = `${colours.accent}59`;
      ctx.fillRect(bar.left, bar.top, bar.width, tall);
      ctx.fillStyle = colours.accent;
      ctx.fillRect(bar.left + bar.width - 2, bar.top, 2, tall);
      for (const ms of votes.atMs[i]) ctx.fillRect(Math.round(x(ms / shown.frame.dtMs)) - 1, top + 1, 3, height - 3);
      ctx.fillStyle = colours.text;
      ctx.font = fontFor(fontSize, 1, 650);
      ctx.textAlign = "left";
      ctx.textBaseline = "middle";
      ctx.fillText(formatCount(count, "vote"), bar.left + bar.width + 5, top + height / 2);
    });
  });
}

/** The same for a screen reader. */
export const votesInWords = ({ counts }: Votes, labels: readonly string[]): string =>
  counts.map((count, i) => `${formatCount(count, "vote")} for ${labels[i]}`).join(", ");
