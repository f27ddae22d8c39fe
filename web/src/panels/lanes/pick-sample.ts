import { showPanel } from "../../bench/dock";
import { useView } from "../../bench/view-store";

/** Ask why a diagnoser believed what it did at a sample; the panel that answers comes to the front. */
export function pickSample(diagnoser: string, tick: number): void {
  useView.setState({ sample: { diagnoser, tick } });
  showPanel("why");
}
