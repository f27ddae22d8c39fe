import "dockview-react/dist/styles/dockview.css";
import "./dock.css";
import { IconMaximize, IconMinimize, IconX } from "@tabler/icons-react";
import {
  DockviewDefaultTab,
  DockviewReact,
  type IDockviewHeaderActionsProps,
  type IDockviewPanelHeaderProps,
  type IDockviewPanelProps,
} from "dockview-react";
import { type FunctionComponent, type KeyboardEvent, useEffect } from "react";
import { hasAxes } from "../api/fits";
import { PanelVisible } from "../api/panel-visible";
import { closePanel, DOCK_GAP, dockNow } from "../bench/dock";
import { type PanelName, VIEWS } from "../bench/panel-views";
import { useBench } from "../stream/bench-store";
import { usePageVisible } from "../ui/on-screen";
import { attachDock, keepLayout, layOutFor } from "./layouts";
import { PanelBody } from "./panel-body";
import { PanelMenu } from "./panel-menu";
import { viewShown } from "./panels";
import { useDockValue } from "./use-dock-value";
import { ViewChoice } from "./view-choice";

const THEME = { name: "combbench", className: "dockview-theme-combbench", gap: DOCK_GAP };

const components = Object.fromEntries((Object.keys(VIEWS) as PanelName[]).map((name) => [name, dockPanel(name)]));

/** The panels, docked; they keep their places in this browser. */
export function Workspace() {
  const axes = useBench((s) => s.bench && hasAxes(s.bench));
  const ofRecord = useBench((s) => Boolean(s.bench?.record));
  useEffect(() => {
    if (axes !== undefined) layOutFor(axes, ofRecord);
  }, [axes, ofRecord]);
  return (
    <main className="workspace" onKeyDownCapture={closeByKey}>
      <DockviewReact
        components={components}
        defaultTabComponent={Tab}
        rightHeaderActionsComponent={GroupActions}
        theme={THEME}
        disableFloatingGroups
        onReady={({ api }) => attachDock(api)}
      />
    </main>
  );
}

function dockPanel(name: PanelName): FunctionComponent<IDockviewPanelProps> {
  return function DockPanel({ api, params }: IDockviewPanelProps) {
    const shown = useDockValue(api.onDidVisibilityChange, () => api.isVisible);
    const page = usePageVisible();
    return (
      <PanelVisible value={shown && page}>
        <PanelBody
          view={viewShown(name, params.view)}
          params={params}
          setParams={(next) => {
            api.updateParameters(next);
            keepLayout();
          }}
        />
      </PanelVisible>
    );
  };
}

/** A tab is one control, so its cross is for the pointer alone; the keyboard closes by Delete, or in the menu. */
function Tab(props: IDockviewPanelHeaderProps) {
  return (
    <>
      <DockviewDefaultTab hideClose {...props} />
      <span
        className="dock-close"
        aria-hidden="true"
        title="Close"
        onPointerDown={(event) => event.stopPropagation()}
        onClick={() => {
          const panel = props.containerApi.getPanel(props.api.id);
          if (panel) closePanel(panel);
        }}
      >
        <IconX size={12} />
      </span>
    </>
  );
}

/** Close the panel whose tab has the keyboard, before the dock does it for good; the next tab has it then. */
function closeByKey(event: KeyboardEvent<HTMLElement>): void {
  const tab = event.target as HTMLElement;
  if ((event.key !== "Delete" && event.key !== "Backspace") || !tab.matches("[role=tab]")) return;
  const panel = dockNow()?.getPanel(tab.dataset.tabPanelId ?? "");
  if (!panel) return;
  event.preventDefault();
  event.stopPropagation();
  const strip = tab.closest("[role=tablist]");
  closePanel(panel);
  strip?.querySelector<HTMLElement>("[role=tab][aria-selected=true]")?.focus();
}

function GroupActions({ containerApi, group, activePanel }: IDockviewHeaderActionsProps) {
  const maximised = useDockValue(containerApi.onDidMaximizedGroupChange, () => containerApi.hasMaximizedGroup());
  const fill = maximised ? "Back to all panels" : "Fill the page with this panel";
  return (
    <div className="dock-actions">
      {activePanel && <ViewChoice panel={activePanel} />}
      <PanelMenu group={group} activePanel={activePanel} />
      <button
        type="button"
        aria-label={fill}
        title={fill}
        onClick={() =>
          maximised ? containerApi.exitMaximizedGroup() : activePanel && containerApi.maximizeGroup(activePanel)
        }
      >
        {maximised ? <IconMinimize size={14} /> : <IconMaximize size={14} />}
      </button>
    </div>
  );
}
