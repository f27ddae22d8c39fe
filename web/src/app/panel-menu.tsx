import { Box, Menu } from "@mantine/core";
import { IconPlus } from "@tabler/icons-react";
import type { DockviewGroupPanel, IDockviewPanel } from "dockview-react";
import { type KeyboardEvent, useState } from "react";
import { useShallow } from "zustand/react/shallow";
import { addPanel, addScope, closePanel, showPanel } from "../bench/dock";
import { hasSeveral, type PanelName, VIEWS } from "../bench/panel-views";
import { presetsOn } from "../panels/scope/scope-presets";
import { useBench } from "../stream/bench-store";
import styles from "./panel-menu.module.css";
import { PANELS, panelsOn, VIEW, viewsOn } from "./panels";

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
      <Menu.Dropdown className={styles.menu} ref={asDialog}>
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
              <Box component="small" display="block">
                {about}
              </Box>
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
  const bench = axes && { axes };
  const wanted = query.trim().toLowerCase();
  const panels = panelsOn(bench).map((panel) => ({
    key: panel,
    ...PANELS[panel],
    run: () => (hasSeveral(panel) ? addScope("Scope", []) : openPanel(panel)),
  }));
  if (!wanted) return panels;
  const views = panelsOn(bench).flatMap((panel) =>
    viewsOn(panel, bench)
      .slice(1)
      .map((view) => ({
        key: view,
        title: VIEW[view].title,
        about: `A view of ${PANELS[panel].title}`,
        run: () => (hasSeveral(panel) ? void addPanel(view) : showPanel(view)),
      })),
  );
  const scopes = presetsOn(signals ?? []).map((preset) => ({
    key: `scope ${preset.title}`,
    title: preset.title,
    about: `A scope on ${preset.signals.slice(0, 3).join(", ")}${preset.signals.length > 3 ? ", …" : ""}`,
    run: () => addScope(preset.title, preset.signals),
  }));
  const all = [...panels, ...views, ...scopes];
  const found = (entry: Entry, part: "title" | "about") => entry[part].toLowerCase().includes(wanted);
  return [...all.filter((e) => found(e, "title")), ...all.filter((e) => !found(e, "title") && found(e, "about"))];
}

/** Enter opens the first entry; once the arrows have marked another, the menu itself opens that. */
function openFirst({ key, currentTarget }: KeyboardEvent<HTMLInputElement>): void {
  const menu = currentTarget.closest("[role=dialog]");
  if (key === "Enter" && !menu?.querySelector("[data-menu-active]"))
    menu?.querySelector<HTMLElement>("[role=menuitem]")?.click();
}

const openPanel = (panel: PanelName): void => void addPanel(VIEWS[panel][0]);
