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
  IconMoon,
  IconPlayerRecord,
  IconPlayerRecordFilled,
  IconShare2,
  IconSun,
} from "@tabler/icons-react";
import type { ReactNode } from "react";
import { actions } from "../../bench/actions";
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

interface Tool {
  label: string;
  icon: ReactNode;
  run(): void;
}

/** Keep, branch, arrange: what is not about running. On a narrow page it folds into one menu. */
export function Tools() {
  const scheme = useScheme();
  const { width } = useViewportSize();
  const scale = useView((s) => (s.large ? s.fontPx / LECTURE_PX : 1));
  const narrow = (width || window.innerWidth) / scale < ROOM_PX;
  const recording = useBench((s) => (s.bench?.recording.length ?? 0) > 0);
  const undo = useBench((s) => s.bench?.undo?.seq !== undefined && benchChange("undo")?.text);
  const redo = useBench((s) => s.bench?.redo?.seq !== undefined && benchChange("redo")?.text);
  const keep: Tool[] = [
    {
      label: undo ? `Undo: ${undo} (Ctrl Z)` : "Undo (Ctrl Z)",
      icon: <IconArrowBackUp size={19} />,
      run: () => takeBack("undo"),
    },
    {
      label: redo ? `Redo: ${redo} (Ctrl Y)` : "Redo (Ctrl Y)",
      icon: <IconArrowForwardUp size={19} />,
      run: () => takeBack("redo"),
    },
    {
      label: recording ? "Stop recording (V)" : "Record every signal (V)",
      icon: recording ? <IconPlayerRecordFilled size={19} color="var(--alarm)" /> : <IconPlayerRecord size={19} />,
      run: actions.record,
    },
    { label: "Save what happened as a scenario (S)", icon: <IconDeviceFloppy size={19} />, run: actions.saveScenario },
    { label: "Fork: a copy of this bench from now on (F)", icon: <IconGitFork size={19} />, run: actions.fork },
    { label: "Keep this moment, to fork from later (K)", icon: <IconBookmark size={19} />, run: actions.keep },
    { label: "Share this experiment by a link (Shift S)", icon: <IconShare2 size={19} />, run: actions.share },
  ];
  const page: Tool[] = [
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

function Button({ label, icon, run }: Tool) {
  return (
    <Tooltip label={label}>
      <ActionIcon size={34} variant="subtle" aria-label={label} onClick={run}>
        {icon}
      </ActionIcon>
    </Tooltip>
  );
}
