import { isServed } from "../api/me";
import { useBench } from "../stream/bench-store";
import { stream } from "../stream/stream";
import { panelWith, showBeside, showPanel } from "./dock";
import { useView } from "./view-store";

/** Below this width lanes have no room for a neighbour, px. */
const LANES_PX = 800;

/** Beside the lanes, or among the faults below them where the lanes are narrow. */
function showWhy(): void {
  const lanes = panelWith("lanes");
  if (lanes && lanes.api.width < LANES_PX && !panelWith("why") && panelWith("faults")) showPanel("why", "faults");
  else showBeside("why", "lanes");
}

/** Ask for the reasons of a verdict at a sample; the panel Why opens beside or below the lanes. */
export function pickSample(diagnoser: string, tick: number): void {
  if (!isServed()) return; // a server works them out
  useView.setState({ sample: { diagnoser, tick: Math.max(0, tick) } });
  showWhy();
}

/** Ask it of the newest sample, of the diagnoser that was asked last or else the first. */
export function askLatest(): void {
  const weighing = weighingDiagnosers();
  const asked = useView.getState().sample?.diagnoser;
  const diagnoser = asked !== undefined && weighing.includes(asked) ? asked : weighing[0];
  if (diagnoser !== undefined) pickSample(diagnoser, stream.client.head.tick - 1);
  else showWhy();
}

/** The diagnosers of the bench that choose between hypotheses. */
export function weighingDiagnosers(): string[] {
  return Object.entries(useBench.getState().bench?.diagnosers ?? {}).flatMap(([id, { names }]) =>
    names.length ? [id] : [],
  );
}
