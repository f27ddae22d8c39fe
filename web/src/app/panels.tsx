import type { ComponentType } from "react";
import { hasAxes } from "../api/fits";
import { isServed } from "../api/me";
import type { Bench, Question } from "../api/types";
import { type PanelName, panelOf, VIEWS, type ViewName } from "../bench/panel-views";
import { AdaptationPanel } from "../panels/adaptation/adaptation-panel";
import { AllanPanel } from "../panels/allan/allan-panel";
import { BehaviourPanel } from "../panels/behaviour/behaviour-panel";
import { BlindPanel } from "../panels/blind/blind-panel";
import { ParametersView } from "../panels/card/block-values";
import { CardPanel } from "../panels/card/card-panel";
import { ClaimsPanel } from "../panels/claims/claims-panel";
import { BehindView } from "../panels/compare/behind-view";
import { ControllersPanel } from "../panels/controllers/controllers-panel";
import { BoardView, DeviceView, EnvironmentView, SensorView } from "../panels/device/device-panel";
import { EventsPanel } from "../panels/events/events-panel";
import { FaultsPanel } from "../panels/faults/faults-panel";
import { GamesPanel } from "../panels/games/games-panel";
import { HypothesesPanel } from "../panels/hypotheses/hypotheses-panel";
import { IdentifyPanel } from "../panels/identify/identify-panel";
import { LabsPanel } from "../panels/labs/labs-panel";
import { LanesPanel } from "../panels/lanes/lanes-panel";
import { LocusPanel } from "../panels/locus/locus-panel";
import { NarratorPanel } from "../panels/narrator/narrator-panel";
import { PhasePanel } from "../panels/phase/phase-panel";
import { RecordingsPanel } from "../panels/recordings/recordings-panel";
import { SchematicPanel } from "../panels/schematic/schematic-panel";
import { ScopePanel } from "../panels/scope/scope-panel";
import { ScoreboardPanel } from "../panels/scoreboard/scoreboard-panel";
import { SetsPanel } from "../panels/sets/sets-panel";
import { SheetPanel } from "../panels/sheet/sheet-panel";
import { SpectrumPanel } from "../panels/spectrum/spectrum-panel";
import { TwinsPanel } from "../panels/twins/twins-panel";
import { View3dPanel } from "../panels/view3d/view3d-panel";
import { VotePanel } from "../panels/vote/vote-panel";
import { WhyPanel } from "../panels/why/why-panel";
import { type ScopeConfig, scopeConfig } from "../stream/scope-config";

export interface PanelParams {
  view?: string;
  scope?: ScopeConfig;
}

export interface PanelProps {
  params: PanelParams;
  setParams(params: PanelParams): void;
}

/** One view of a panel. */
interface View {
  title: string;
  /** A server computes or keeps its contents. */
  needs?: "server";
  /** It does something to the bench, which a recording that is played does not allow. */
  changes?: boolean;
  /** It works with the data that the server serves while a fault is hidden, always or for some questions. */
  whileBlind?: true | ((question: Question) => boolean);
  /** The benches it is for, unless for all: those with one displacement, or those with axes. */
  only?: "displacement" | "axes";
  component: ComponentType<PanelProps>;
}

export interface Panel {
  title: string;
  /** A line for the menu. */
  about: string;
}

/** The panels, in the words of the menu; their views are in `VIEWS`. */
export const PANELS: Record<PanelName, Panel> = {
  device: { title: "Device", about: "Choose the device, its sensor and its surroundings" },
  loop: { title: "Loop", about: "The control loop as a diagram; equations and values of each block" },
  controller: { title: "Controller", about: "Choose a controller, tune it, watch it adapt" },
  faults: { title: "Faults", about: "Inject faults and remove them" },
  scope: { title: "Scope", about: "Signals over time, as a spectrum or in the phase plane" },
  response: { title: "Frequency response", about: "Sweep the device with a sine and fit mass, spring and damping" },
  view3d: { title: "3D", about: "The moving device, in three dimensions or from above" },
  diagnosis: { title: "Diagnosis", about: "Probability of each hypothesis, and how often the verdict is right" },
  why: { title: "Why", about: "The numbers behind one verdict" },
  compare: { title: "Compare", about: "Twins, branches, recordings and past runs beside the bench" },
  log: { title: "Log", about: "Events in sentences, with the commands behind them" },
  published: { title: "Published", about: "Printed claims beside our figures" },
  lesson: { title: "Lesson", about: "Lab sheet, vote, hidden fault and games" },
  motion: { title: "Motion", about: "The path of the mass in its plane" },
  rate: { title: "Rate", about: "Allan deviation of the estimated rate" },
};

/** Every view; a new one is its folder, its name in `VIEWS` and a line here. */
export const VIEW: Record<ViewName, View> = {
  device: { title: "Device", needs: "server", changes: true, component: DeviceView },
  sensor: { title: "Sensor", needs: "server", changes: true, component: SensorView },
  environment: { title: "Environment", needs: "server", changes: true, component: EnvironmentView },
  board: { title: "Board", needs: "server", changes: true, component: BoardView },
  schematic: { title: "Diagram", component: SchematicPanel },
  card: { title: "Block", component: CardPanel },
  controllers: { title: "Choice", whileBlind: true, changes: true, component: ControllersPanel },
  parameters: { title: "Parameters", needs: "server", changes: true, component: ParametersView },
  sets: { title: "Sets", needs: "server", changes: true, component: SetsPanel },
  adaptation: { title: "Adaptation", only: "displacement", component: AdaptationPanel },
  behaviour: { title: "Behaviour", only: "displacement", component: BehaviourPanel },
  faults: { title: "Faults", changes: true, component: FaultsPanel },
  time: { title: "Time", whileBlind: true, component: Scope },
  spectrum: { title: "Spectrum", whileBlind: true, component: SpectrumPanel },
  phase: { title: "Phase plane", component: PhasePanel },
  identify: {
    title: "Frequency response",
    needs: "server",
    only: "displacement",
    whileBlind: ({ game }) => !game,
    changes: true,
    component: IdentifyPanel,
  },
  view3d: { title: "3D", component: View3dPanel },
  lanes: { title: "Lanes", whileBlind: ({ shows }) => shows.length > 0, component: LanesPanel },
  hypotheses: { title: "Hypotheses", needs: "server", only: "displacement", changes: true, component: HypothesesPanel },
  labs: { title: "Noise and memory", needs: "server", only: "displacement", changes: true, component: LabsPanel },
  scores: { title: "Scoreboard", component: ScoreboardPanel },
  why: { title: "Why", needs: "server", component: WhyPanel },
  twins: { title: "Twins", needs: "server", changes: true, component: TwinsPanel },
  behind: { title: "Branches and runs", component: BehindView },
  recordings: { title: "Recordings", needs: "server", component: RecordingsPanel },
  narrator: { title: "Narrator", needs: "server", whileBlind: true, component: NarratorPanel },
  events: { title: "Events", whileBlind: true, component: EventsPanel },
  claims: { title: "Claims", needs: "server", component: ClaimsPanel },
  sheet: { title: "Lab sheet", needs: "server", whileBlind: true, changes: true, component: SheetPanel },
  vote: { title: "Vote", needs: "server", whileBlind: true, component: VotePanel },
  blind: { title: "Hidden fault", needs: "server", whileBlind: true, changes: true, component: BlindPanel },
  games: { title: "Games", needs: "server", whileBlind: true, changes: true, component: GamesPanel },
  locus: { title: "Motion", only: "axes", component: LocusPanel },
  allan: { title: "Allan deviation", needs: "server", only: "axes", component: AllanPanel },
};

export type Benchlike = Pick<Bench, "axes"> | undefined;

/** Whether a view has something to show on a bench; before there is one, all may. */
export const suits = ({ only }: Pick<View, "only">, bench: Benchlike): boolean =>
  only === undefined || bench === undefined || (only === "axes") === hasAxes(bench);

/** Whether a view works on this page. */
export const isHere = (view: ViewName): boolean => VIEW[view].needs === undefined || isServed();

/** Whether a view works while the answer to a question is hidden. */
export const servedIn = ({ whileBlind }: Pick<View, "whileBlind">, question: Question): boolean =>
  typeof whileBlind === "function" ? whileBlind(question) : whileBlind === true;

/** The views of a panel that suit a bench. */
export const viewsOn = (panel: PanelName, bench: Benchlike): ViewName[] =>
  VIEWS[panel].filter((view) => isHere(view) && suits(VIEW[view], bench));

/** The panels that suit a bench. */
export const panelsOn = (bench: Benchlike): PanelName[] =>
  (Object.keys(VIEWS) as PanelName[]).filter((panel) => viewsOn(panel, bench).length > 0);

/** The view that a panel shows: the chosen one if it is a view of the panel, else the first that is here. */
export const viewShown = (panel: PanelName, chosen: string | undefined): ViewName =>
  chosen !== undefined && panelOf(chosen) === panel
    ? (chosen as ViewName)
    : ((VIEWS[panel] as readonly ViewName[]).find(isHere) ?? VIEWS[panel][0]);

function Scope({ params, setParams }: PanelProps) {
  return <ScopePanel config={params.scope ?? scopeConfig([])} onChange={(scope) => setParams({ ...params, scope })} />;
}
