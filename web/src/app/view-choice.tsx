import { Menu } from "@mantine/core";
import { IconChevronDown } from "@tabler/icons-react";
import type { IDockviewPanel } from "dockview-react";
import { useShallow } from "zustand/react/shallow";
import { turnTo, viewOf } from "../bench/dock";
import type { PanelName } from "../bench/panel-views";
import { useBench } from "../stream/bench-store";
import { PANELS, VIEW, viewShown, viewsOn } from "./panels";
import { useDockValue } from "./use-dock-value";

/** Width of a letter and of the space around a name, px: the names form a row if the header has room for it. */
const LETTER_PX = 7;
const AROUND_PX = 18;

/** The views of a docked panel: in a row, or in a menu where the row has no room. */
export function ViewChoice({ panel, room }: { panel: IDockviewPanel; room: number }) {
  const name = panel.view.contentComponent as PanelName;
  const axes = useBench(useShallow((s) => s.bench?.axes));
  const shown = viewShown(
    name,
    useDockValue(panel.api.onDidParametersChange, () => viewOf(panel)),
  );
  const views = viewsOn(name, axes && { axes });
  if (views.length < 2) return null;
  const wide = views.reduce((sum, view) => sum + AROUND_PX + LETTER_PX * VIEW[view].title.length, 0);
  const label = `Views of ${PANELS[name].title}`;
  if (wide > room)
    return (
      <Menu position="bottom-end">
        <Menu.Target>
          <button type="button" className="dock-view" aria-label={`${label}: ${VIEW[shown].title}`}>
            {VIEW[shown].title} <IconChevronDown size={12} />
          </button>
        </Menu.Target>
        <Menu.Dropdown>
          {views.map((view) => (
            <Menu.Item key={view} aria-current={view === shown} onClick={() => turnTo(panel, view)}>
              {VIEW[view].title}
            </Menu.Item>
          ))}
        </Menu.Dropdown>
      </Menu>
    );
  return (
    // biome-ignore lint/a11y/useSemanticElements: a fieldset has no place in the bar of tabs
    <div className="dock-views" role="group" aria-label={label}>
      {views.map((view) => (
        <button
          key={view}
          type="button"
          className="dock-view"
          aria-pressed={view === shown}
          onClick={() => turnTo(panel, view)}
        >
          {VIEW[view].title}
        </button>
      ))}
    </div>
  );
}
