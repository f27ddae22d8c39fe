import { notifications } from "@mantine/notifications";
import { announce } from "../bench/announce";
import { benchChange, changeBench, type Way } from "../bench/undo";
import { layoutHistory } from "./layout-history";
import { putLayout } from "./layouts";

/** Undo the last change of the bench or of the layout; or redo the last change that was undone. */
export function takeBack(way: Way): void {
  const bench = benchChange(way);
  const layout = layoutHistory.lastAt(way);
  const sign = way === "undo" ? 1 : -1;
  if (layout !== undefined && (!bench || sign * layout > sign * bench.at)) {
    layoutHistory.go(way, putLayout);
    announce(way === "undo" ? "Layout as it was before" : "Layout changed again");
  } else if (bench) void changeBench(way);
  else notifications.show({ id: "undoable", message: `There is nothing to ${way}.`, autoClose: 3000 });
}
