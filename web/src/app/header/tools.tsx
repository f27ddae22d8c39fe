import { ActionIcon, Menu, Tooltip } from "@mantine/core";
import { useViewportSize } from "@mantine/hooks";
import {
  IconArrowBackUp,
  IconArrowForwardUp,
  IconBookmark,
  IconDeviceFloppy,
  IconDots,
  IconGitFork,
  IconKeyboard,
  IconLayoutDashboard,
  IconMessage,
  IconMessageOff,
  IconMoon,
  IconPlayerRecord,
  IconPlayerRecordFilled,
  IconPresentation,
  IconShare2,
  IconSun,
} from "@tabler/icons-react";
import type { ReactNode } from "react";
import { classes } from "../../api/classes";
import { may, type Right, useMay, useMe } from "../../api/me";
import { useClasses } from "../../api/use-classes";
import { actions } from "../../bench/actions";
import { useCompany } from "../../bench/driving";
import { toggleNarrator, useNarrator } from "../../bench/narrator";
import { showError } from "../../bench/send";
import { benchChange } from "../../bench/undo";
import { LECTURE_PX, useView } from "../../bench/view-store";
import { useBench } from "../../stream/bench-store";
import { useScheme } from "../../ui/use-canvas";
import { takeBack } from "../take-back";
import { themeSwitch } from "../theme";
import styles from "./header.module.css";
import { LayoutItems } from "./layout-items";

/** Below this width, in letters of the usual size, the titles want the room of the tools. */
const ROOM_PX = 1400;
/** What one more tool takes, and who is here. */
const TOOL_PX = 40;
const COMPANY_PX = 140;

interface Tool {
  label: string;
  icon: ReactNode;
  needs?: Right;
  run(): void;
}

/** Keep, branch, arrange: what is not about running. On a narrow page it folds into one menu. */
export function Tools() {
  const scheme = useScheme();
  const { width } = useViewportSize();
  const scale = useView((s) => (s.large ? s.fontPx / LECTURE_PX : 1));
  const show = useShow();
  const room = ROOM_PX + TOOL_PX * show.length + (useCompany() ? COMPANY_PX : 0);
  const narrow = (width || window.innerWidth) / scale < room;
  const recording = useBench((s) => (s.bench?.recording.length ?? 0) > 0);
  const undo = useBench((s) => s.bench?.undo?.seq !== undefined && benchChange("undo")?.text);
  const redo = useBench((s) => s.bench?.redo?.seq !== undefined && benchChange("redo")?.text);
  const narrates = useNarrator((s) => s.on);
  const role = useMe((s) => s.me?.role);
  useMay("drive"); // which depends on the bench, too
  const all: Tool[] = [
    {
      label: undo ? `Undo: ${undo} (Ctrl Z)` : "Undo (Ctrl Z)",
      icon: <IconArrowBackUp size={19} />,
      needs: "drive",
      run: () => takeBack("undo"),
    },
    {
      label: redo ? `Redo: ${redo} (Ctrl Y)` : "Redo (Ctrl Y)",
      icon: <IconArrowForwardUp size={19} />,
      needs: "drive",
      run: () => takeBack("redo"),
    },
    {
      label: recording ? "Stop recording (V)" : "Record every signal (V)",
      icon: recording ? <IconPlayerRecordFilled size={19} color="var(--alarm)" /> : <IconPlayerRecord size={19} />,
      needs: "drive",
      run: actions.record,
    },
    { label: "Save what happened as a scenario (X)", icon: <IconDeviceFloppy size={19} />, run: actions.saveScenario },
    {
      label: "Fork: a copy of this bench from now on (F)",
      icon: <IconGitFork size={19} />,
      needs: "teach",
      run: actions.fork,
    },
    {
      label: "Keep this moment on the timeline (K)",
      icon: <IconBookmark size={19} />,
      needs: "teach",
      run: actions.keep,
    },
    {
      label: "Share this experiment by a link (Shift S)",
      icon: <IconShare2 size={19} />,
      needs: "teach",
      run: actions.share,
    },
    ...show,
  ];
  const keep = all.filter(({ needs }) => !needs || may(needs, role));
  const page: Tool[] = [
    {
      label: narrates ? "Narrator off (Q)" : "Narrator on: say in sentences what happens (Q)",
      icon: narrates ? <IconMessageOff size={19} /> : <IconMessage size={19} />,
      run: toggleNarrator,
    },
    {
      label: scheme === "dark" ? "Light theme (D)" : "Dark theme (D)",
      icon: scheme === "dark" ? <IconSun size={19} /> : <IconMoon size={19} />,
      run: () => themeSwitch.flip(),
    },
    { label: "Keyboard ( ? )", icon: <IconKeyboard size={19} />, run: actions.keys },
  ];

  if (narrow)
    return (
      <Menu width={320} position="bottom-end" shadow="md">
        <Menu.Target>
          <ActionIcon size={34} variant="subtle" aria-label="More">
            <IconDots size={19} />
          </ActionIcon>
        </Menu.Target>
        <Menu.Dropdown>
          {[...keep, ...page].map((tool) => (
            <Menu.Item key={tool.label} leftSection={tool.icon} onClick={tool.run}>
              {tool.label}
            </Menu.Item>
          ))}
          <Menu.Divider />
          <LayoutItems />
        </Menu.Dropdown>
      </Menu>
    );
  return (
    <div className={styles.tools}>
      {keep.map((tool) => (
        <Button key={tool.label} {...tool} />
      ))}
      <Menu width={320} position="bottom-end" shadow="md">
        <Menu.Target>
          <ActionIcon size={34} variant="subtle" aria-label="Layout" title="Layout">
            <IconLayoutDashboard size={19} />
          </ActionIcon>
        </Menu.Target>
        <Menu.Dropdown>
          <LayoutItems />
        </Menu.Dropdown>
      </Menu>
      {page.map((tool) => (
        <Button key={tool.label} {...tool} />
      ))}
    </div>
  );
}

/** Showing the bench to a class, where there is one; with several, each has a button on its own page. */
function useShow(): Tool[] {
  const { all, again } = useClasses();
  const bench = useBench((s) => s.bench?.id);
  const [group, ...others] = all;
  if (!group || !bench || others.length > 0 || group.shown === bench) return [];
  return [
    {
      label: `Show this bench to all of ${group.name}`,
      icon: <IconPresentation size={19} />,
      needs: "teach",
      run: () => void classes.show(group.id, bench).then(again, showError),
    },
  ];
}

function Button({ label, icon, run }: Tool) {
  return (
    <Tooltip label={label}>
      <ActionIcon size={34} variant="subtle" aria-label={label} onClick={run}>
        {icon}
      </ActionIcon>
    </Tooltip>
  );
}
