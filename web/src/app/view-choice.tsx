import { Menu } from "@mantine/core";
import { IconChevronDown } from "@tabler/icons-react";
import type { IDockviewPanel } from "dockview-react";
import { useShallow } from "zustand/react/shallow";
import { turnTo, viewOf } from "../bench/dock";
import type { PanelName } from "../bench/panel-views";
import { useBench } from "../stream/bench-store";
import { PANELS, VIEW, viewShown, viewsOn } from "./panels";
import { useDockValue } from "./use-dock-value";

/** The views of a docked panel, in a menu. */
export function ViewChoice({ panel }: { panel: IDockviewPanel }) {
  const name = panel.view.contentComponent as PanelName;
  const axes = useBench(useShallow((s) => s.bench?.axes));
  const shown = viewShown(
    name,
    useDockValue(panel.api.onDidParametersChange, () => viewOf(panel)),
  );
  const views = viewsOn(name, axes && { axes });
  if (views.length < 2) return null;
  const label = `Views of ${PANELS[name].title}: ${VIEW[shown].title}`;
  return (
    <Menu position="bottom-end" returnFocus>
      <Menu.Target>
        <button type="button" className="dock-view" aria-label={label} title={label}>
          <span>{VIEW[shown].title}</span> <IconChevronDown size={12} />
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
}
