import { Box, Menu } from "@mantine/core";
import { IconPlus } from "@tabler/icons-react";
import type { DockviewGroupPanel, IDockviewPanel } from "dockview-react";
import { type KeyboardEvent, useState } from "react";
import { useShallow } from "zustand/react/shallow";
import { addPanel, addScope, closePanel, showPanel } from "../bench/dock";
import { hasSeveral, type ViewName } from "../bench/panel-views";
import { presetsOn } from "../panels/scope/scope-presets";
import { useBench } from "../stream/bench-store";
import { ranked } from "./search/find";
import { viewEntries } from "./view-entries";

interface Entry {
  key: string;
  title: string;
  about: string;
  run(): void;
}

/** Every panel with a line of words; a search finds views and scopes as well. */
export function PanelMenu({
  group,
  activePanel,
}: {
  group: DockviewGroupPanel;
  activePanel: IDockviewPanel | undefined;
}) {
  const [query, setQuery] = useState("");
  const entries = useEntries(query);
  return (
    <Menu position="bottom-end" width={360} returnFocus>
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
      <Menu.Dropdown mah="min(640px, calc(100vh - 80px))" ref={asDialog}>
        <Menu.Search
          size="xs"
          m="4px 4px 8px"
          aria-label="Search panels, views and signals"
          placeholder="Search panels, views, signals"
          value={query}
          onChange={(event) => setQuery(event.currentTarget.value)}
          onKeyDown={openFirst}
        />
        <div role={entries.length > 0 ? "menu" : undefined}>
          {entries.map(({ key, title, about, run }) => (
            <Menu.Item key={key} onClick={run}>
              {title}
              <small>{about}</small>
            </Menu.Item>
          ))}
          {activePanel && !query && (
            <>
              <Menu.Divider />
              <Menu.Item onClick={() => closePanel(activePanel)}>Close {activePanel.title}</Menu.Item>
            </>
          )}
        </div>
        {entries.length === 0 && (
          <Box component="p" m="8px 12px" c="dimmed">
            No panel, view or signal has this name.
          </Box>
        )}
      </Menu.Dropdown>
    </Menu>
  );
}

/** A menu cannot have a search field; so the frame is a dialog, and the entries in it are the menu. */
function asDialog(frame: HTMLElement | null): void {
  frame?.setAttribute("role", "dialog");
  frame?.removeAttribute("aria-orientation");
}

function useEntries(query: string): Entry[] {
  const axes = useBench(useShallow((s) => s.bench?.axes));
  const signals = useBench((s) => s.bench?.signals);
  const views = viewEntries(axes && { axes }).map(({ panel, view, isFirst, title, about }) => ({
    key: view,
    title,
    about,
    isFirst,
    run: () => openView(view, isFirst, hasSeveral(panel)),
  }));
  if (!query.trim()) return views.filter(({ isFirst }) => isFirst);
  const scopes = presetsOn(signals ?? []).map((preset) => ({
    key: `scope ${preset.title}`,
    title: preset.title,
    about: `A scope on ${preset.signals.slice(0, 3).join(", ")}${preset.signals.length > 3 ? ", …" : ""}`,
    run: () => addScope(preset.title, preset.signals),
  }));
  const panels = [...views.filter(({ isFirst }) => isFirst), ...views.filter(({ isFirst }) => !isFirst)];
  return ranked([...panels, ...scopes], query);
}

/** Another panel for the first view of a panel, the view itself for the others; a scope opens once more. */
function openView(view: ViewName, isFirst: boolean, several: boolean): void {
  if (isFirst && several) addScope("Scope", []);
  else if (isFirst || several) addPanel(view);
  else showPanel(view);
}

/** Enter opens the first entry; once the arrows have marked another, the menu itself opens that. */
function openFirst({ key, currentTarget }: KeyboardEvent<HTMLInputElement>): void {
  const menu = currentTarget.closest("[role=dialog]");
  if (key === "Enter" && !menu?.querySelector("[data-menu-active]"))
    menu?.querySelector<HTMLElement>("[role=menuitem]")?.click();
}
