import type { ComponentType } from "react";
import { hasAxes } from "../api/fits";
import type { Bench } from "../api/types";
import { AdaptationPanel } from "../panels/adaptation/adaptation-panel";
import { AllanPanel } from "../panels/allan/allan-panel";
import { BehaviourPanel } from "../panels/behaviour/behaviour-panel";
import { BlindPanel } from "../panels/blind/blind-panel";
import { CardPanel } from "../panels/card/card-panel";
import { ClaimsPanel } from "../panels/claims/claims-panel";
import { ControllersPanel } from "../panels/controllers/controllers-panel";
import { EditorPanel } from "../panels/editor/editor-panel";
import { EnvironmentPanel } from "../panels/environment/environment-panel";
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

export interface PanelProps {
  params: { scope?: ScopeConfig };
  setParams(params: { scope?: ScopeConfig }): void;
}

export interface PanelKind {
  title: string;
  /** It does something to the bench, which a recording that is played does not allow. */
  changes?: boolean;
  /** It works with what the server serves while a fault is to be found. */
  whileBlind?: boolean;
  /** The benches it is for, unless for all: those with one displacement, or those with axes. */
  only?: "displacement" | "axes";
  component: ComponentType<PanelProps>;
}

/** Every kind of panel; a new one is its folder and a line here. */
export const PANELS: Record<string, PanelKind> = {
  scope: { title: "Scope", whileBlind: true, component: Scope },
  lanes: { title: "Diagnosis", whileBlind: true, component: LanesPanel },
  adaptation: { title: "Adaptation", only: "displacement", component: AdaptationPanel },
  behaviour: { title: "Behaviour", only: "displacement", component: BehaviourPanel },
  hypotheses: { title: "Hypotheses", only: "displacement", changes: true, component: HypothesesPanel },
  labs: { title: "Noise and memory", only: "displacement", changes: true, component: LabsPanel },
  blind: { title: "Blind diagnosis", whileBlind: true, changes: true, component: BlindPanel },
  games: { title: "Games", whileBlind: true, changes: true, component: GamesPanel },
  sheet: { title: "Lab sheet", whileBlind: true, changes: true, component: SheetPanel },
  twins: { title: "Twins", changes: true, component: TwinsPanel },
  why: { title: "Why", component: WhyPanel },
  schematic: { title: "Bench", component: SchematicPanel },
  controllers: { title: "Controllers", whileBlind: true, changes: true, component: ControllersPanel },
  locus: { title: "Locus", only: "axes", component: LocusPanel },
  allan: { title: "Allan deviation", only: "axes", component: AllanPanel },
  faults: { title: "Faults", changes: true, component: FaultsPanel },
  card: { title: "Block", component: CardPanel },
  editor: { title: "Editor", changes: true, component: EditorPanel },
  sets: { title: "Parameter sets", changes: true, component: SetsPanel },
  environment: { title: "Environment", changes: true, component: EnvironmentPanel },
  phase: { title: "Phase plane", component: PhasePanel },
  spectrum: { title: "Spectrum", whileBlind: true, component: SpectrumPanel },
  identify: { title: "Swept sine", only: "displacement", changes: true, component: IdentifyPanel },
  recordings: { title: "Recordings", component: RecordingsPanel },
  events: { title: "Events", whileBlind: true, component: EventsPanel },
  narrator: { title: "Narrator", whileBlind: true, component: NarratorPanel },
  claims: { title: "Claims", component: ClaimsPanel },
  scores: { title: "Scoreboard", component: ScoreboardPanel },
  vote: { title: "Vote", whileBlind: true, component: VotePanel },
  view3d: { title: "3D", component: View3dPanel },
};

/** Whether a panel has something to show on a bench; before there is one, all may. */
export const suits = ({ only }: Pick<PanelKind, "only">, bench: Pick<Bench, "axes"> | undefined): boolean =>
  only === undefined || bench === undefined || (only === "axes") === hasAxes(bench);

function Scope({ params, setParams }: PanelProps) {
  return <ScopePanel config={params.scope ?? scopeConfig([])} onChange={(scope) => setParams({ scope })} />;
}
