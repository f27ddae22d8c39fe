import { showPanel } from "../../app/layouts";
import { useView } from "../../app/view-store";

/** Ask why a diagnoser believed what it did at a sample; the panel that answers comes to the front. */
export function pickSample(diagnoser: string, tick: number): void {
  useView.setState({ sample: { diagnoser, tick } });
  showPanel("why");
}
