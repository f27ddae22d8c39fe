import "dockview-react/dist/styles/dockview.css";
import "./dock.css";
import { Menu } from "@mantine/core";
import { IconMaximize, IconMinimize, IconPlus, IconX } from "@tabler/icons-react";
import {
  DockviewDefaultTab,
  DockviewReact,
  type IDockviewHeaderActionsProps,
  type IDockviewPanelHeaderProps,
  type IDockviewPanelProps,
} from "dockview-react";
import { type FunctionComponent, type KeyboardEvent, useEffect, useState } from "react";
import { hasAxes } from "../api/fits";
import { PanelVisible } from "../api/panel-visible";
import { addPanel, addScope, closePanel, DOCK_GAP, dockNow } from "../bench/dock";
import { useBench } from "../stream/bench-store";
import { usePageVisible } from "../ui/on-screen";
import { attachDock, keepLayout, layOutFor } from "./layouts";
import { PanelBody } from "./panel-body";
import { PANELS, type PanelKind, suits } from "./panels";

const THEME = { name: "combbench", className: "dockview-theme-combbench", gap: DOCK_GAP };

const components = Object.fromEntries(Object.entries(PANELS).map(([name, kind]) => [name, dockPanel(kind)]));

/** The panels, docked; they keep their places in this browser. */
export function Workspace() {
  const axes = useBench((s) => s.bench && hasAxes(s.bench));
  useEffect(() => {
    if (axes !== undefined) layOutFor(axes);
  }, [axes]);
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

function dockPanel(kind: PanelKind): FunctionComponent<IDockviewPanelProps> {
  return function DockPanel({ api, params }: IDockviewPanelProps) {
    const [shown, setShown] = useState(api.isVisible);
    const page = usePageVisible();
    useEffect(() => {
      const subscription = api.onDidVisibilityChange((event) => setShown(event.isVisible));
      return () => subscription.dispose();
    }, [api]);
    return (
      <PanelVisible value={shown && page}>
        <PanelBody
          kind={kind}
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
  const panel = () => props.containerApi.getPanel(props.api.id);
  return (
    <>
      <DockviewDefaultTab hideClose {...props} />
      <span
        className="dock-close"
        aria-hidden="true"
        title="Close"
        onPointerDown={(event) => event.stopPropagation()}
        onClick={() => {
          const closing = panel();
          if (closing) closePanel(closing);
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
  const [maximised, setMaximised] = useState(false);
  useEffect(() => {
    const subscription = containerApi.onDidMaximizedGroupChange(() => setMaximised(containerApi.hasMaximizedGroup()));
    return () => subscription.dispose();
  }, [containerApi]);
  const all = useBench((s) => s.bench?.signals);
  const axes = useBench((s) => s.bench?.axes);
  const scopes = SCOPE_PRESETS.map(({ title, pick }) => ({
    title,
    signals: (all ?? []).map((s) => s.name).filter((name) => pick.test(name)),
  })).filter((preset) => preset.signals.length > 0);
  return (
    <div className="dock-actions">
      <Menu position="bottom-end" shadow="md">
        <Menu.Target>
          <button
            type="button"
            aria-label="Add or close panels"
            title="Add or close panels"
            onPointerDown={() => group.api.setActive()}
          >
            <IconPlus size={14} />
          </button>
        </Menu.Target>
        <Menu.Dropdown>
          <Menu.Label>Scopes</Menu.Label>
          {scopes.map(({ title, signals }) => (
            <Menu.Item key={title} onClick={() => addScope(title, signals)}>
              {title}
            </Menu.Item>
          ))}
          <Menu.Item onClick={() => addScope("Scope", [])}>Empty scope</Menu.Item>
          <Menu.Divider />
          {Object.entries(PANELS)
            .filter(([kind, panel]) => kind !== "scope" && suits(panel, axes && { axes }))
            .map(([kind, { title }]) => (
              <Menu.Item key={kind} onClick={() => addPanel(kind)}>
                {title}
              </Menu.Item>
            ))}
          {activePanel && (
            <>
              <Menu.Divider />
              <Menu.Item onClick={() => closePanel(activePanel)}>Close {activePanel.title}</Menu.Item>
            </>
          )}
        </Menu.Dropdown>
      </Menu>
      <button
        type="button"
        aria-label={maximised ? "Back to all panels" : "Fill the page with this panel"}
        title={maximised ? "Back to all panels" : "Fill the page with this panel"}
        onClick={() =>
          maximised ? containerApi.exitMaximizedGroup() : activePanel && containerApi.maximizeGroup(activePanel)
        }
      >
        {maximised ? <IconMinimize size={14} /> : <IconMaximize size={14} />}
      </button>
    </div>
  );
}

/** Scopes worth opening, by the signals they show; what a bench does not have is left out. */
export const SCOPE_PRESETS: { title: string; pick: RegExp }[] = [
  { title: "Displacement", pick: /^(model|plant|sensor)\.displacement$/ },
  { title: "Tracking error", pick: /^model\.tracking_error$/ },
  { title: "Rate, and every estimate of it", pick: /^[a-z_]+\.rate$/ },
  { title: "Motion", pick: /^plant\.(partner_)?[xy]$/ },
  { title: "Forces", pick: /^drive\.(partner_)?[xy]\.force$/ },
  { title: "Quadrature", pick: /^[a-z_]+\.quadrature$/ },
  { title: "What adaptive control learns", pick: /^(adaptive_rate|mimo_adaptive)\.[kd](xx|xy|yy)$/ },
  { title: "Voltage", pick: /^(reference|drive)\.voltage$/ },
  { title: "What each controller would do", pick: /^(?!reference|drive).+\.voltage$/ },
  { title: "Adaptation", pick: /^mrac[^.]*\.gain(_ideal)?\./ },
  { title: "Adaptation error", pick: /^mrac[^.]*\.(error|augmented_error|auxiliary_error)$/ },
  { title: "Residuals", pick: /\.residual\./ },
  { title: "Residuals along x", pick: /\.residual_x\./ },
  { title: "Residuals along y", pick: /\.residual_y\./ },
  { title: "Fault severity", pick: /^faults\./ },
];
