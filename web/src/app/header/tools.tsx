import { ActionIcon, Menu, Tooltip } from "@mantine/core";
import {
  IconBookmark,
  IconDeviceFloppy,
  IconGitFork,
  IconKeyboard,
  IconLayoutDashboard,
  IconMoon,
  IconSun,
} from "@tabler/icons-react";
import { actions } from "../actions";
import { setLayout } from "../layouts";
import { themeSwitch } from "../theme-switch";
import { useScheme } from "../use-scheme";
import { type LayoutName, useView } from "../view-store";
import styles from "./header.module.css";

const LAYOUTS: [LayoutName, string][] = [
  ["lecture", "Scope, lanes and 3D in large type"],
  ["lab", "Bench and faults beside the scopes"],
  ["research", "Everything"],
];

/** Keep, branch, arrange: what is not about running. */
export function Tools() {
  const scheme = useScheme();
  const layout = useView((s) => s.layout);
  return (
    <div className={styles.tools}>
      <Tool
        label="Save what happened as a scenario (TOML)"
        onClick={actions.saveScenario}
        icon={<IconDeviceFloppy size={19} />}
      />
      <Tool label="Fork: a copy of this bench from now on" onClick={actions.fork} icon={<IconGitFork size={19} />} />
      <Tool label="Keep this moment, to fork from later (K)" onClick={actions.keep} icon={<IconBookmark size={19} />} />
      <Menu width={300} position="bottom-end" shadow="md">
        <Menu.Target>
          <ActionIcon size={34} variant="subtle" aria-label="Layout" title="Layout">
            <IconLayoutDashboard size={19} />
          </ActionIcon>
        </Menu.Target>
        <Menu.Dropdown>
          {LAYOUTS.map(([name, what]) => (
            <Menu.Item
              key={name}
              aria-current={name === layout}
              fw={name === layout ? 650 : undefined}
              onClick={() => setLayout(name)}
            >
              {name}
              <small className={styles.menuNote}>{what}</small>
            </Menu.Item>
          ))}
        </Menu.Dropdown>
      </Menu>
      <Tool
        label={scheme === "dark" ? "Light theme (D)" : "Dark theme (D)"}
        onClick={() => themeSwitch.flip()}
        icon={scheme === "dark" ? <IconSun size={19} /> : <IconMoon size={19} />}
      />
      <Tool label="Keyboard ( ? )" onClick={actions.keys} icon={<IconKeyboard size={19} />} />
    </div>
  );
}

function Tool({ label, icon, onClick }: { label: string; icon: React.ReactNode; onClick(): void }) {
  return (
    <Tooltip label={label}>
      <ActionIcon size={34} variant="subtle" aria-label={label} onClick={onClick}>
        {icon}
      </ActionIcon>
    </Tooltip>
  );
}
