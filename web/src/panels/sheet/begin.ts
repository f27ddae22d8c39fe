import { queryClient } from "../../api/queries";
import { sheets } from "../../api/sheets";
import { showAtEdge } from "../../bench/dock";
import { openOwn } from "../../bench/open-bench";
import { setPage, useView } from "../../bench/view-store";

/** The width of a sheet. */
const SHEET_PX = 400;

/** Begin or continue a sheet: its bench is made, and the sheet is shown at the edge. */
export async function beginSheet(id: string): Promise<void> {
  const view = await sheets.begin(id);
  queryClient.setQueryData(["sheet", id], view);
  if (view.bench) openOwn(view.bench);
  setPage("bench");
  useView.setState({ dialog: "none" });
  await queryClient.invalidateQueries({ queryKey: ["sheets"] });
  showSheet();
}

/** Hide the fault of a step, on a new bench of the sheet. */
export async function hideInStep(id: string, step: string): Promise<void> {
  const view = await sheets.hide(id, step);
  queryClient.setQueryData(["sheet", id], view);
  if (view.bench) openOwn(view.bench);
}

/** Bring the sheet to the front, in a column of its own. */
export function showSheet(): void {
  useView.setState({ extra: "sheet" });
  showAtEdge("sheet", SHEET_PX);
}
