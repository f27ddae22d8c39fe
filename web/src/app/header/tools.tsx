import { Button, Menu } from "@mantine/core";
import { IconChevronDown, IconPlayerRecordFilled } from "@tabler/icons-react";
import { classes } from "../../api/classes";
import { may, type Right, useMay, useMe, useServed } from "../../api/me";
import { isInFrame } from "../../api/session";
import { useClasses } from "../../api/use-classes";
import { actions } from "../../bench/actions";
import { toggleNarrator, useNarrator } from "../../bench/narrator";
import { showError } from "../../bench/send";
import { benchChange } from "../../bench/undo";
import { useBench } from "../../stream/bench-store";
import { useScheme } from "../../ui/use-canvas";
import { takeBack } from "../take-back";
import { themeSwitch } from "../theme";
import { LayoutItems } from "./layout-items";

interface Tool {
  label: string;
  needs?: Right;
  run(): void;
}

/** All that is not about running, in one menu: take back, keep and share; the panels; the page. */
export function Tools() {
  const scheme = useScheme();
  const show = useShow();
  const recording = useBench((s) => (s.bench?.recording.length ?? 0) > 0);
  const undo = useBench((s) => s.bench?.undo?.seq !== undefined && benchChange("undo")?.text);
  const redo = useBench((s) => s.bench?.redo?.seq !== undefined && benchChange("redo")?.text);
  const narrates = useNarrator((s) => s.on);
  const role = useMe((s) => s.me?.role);
  const documents = useMe((s) => s.me?.documents);
  const served = useServed();
  useMay("drive"); // which depends on the bench, too
  const bench: Tool[] = [
    { label: undo ? `Undo: ${undo} (Ctrl Z)` : "Undo (Ctrl Z)", needs: "drive", run: () => takeBack("undo") },
    { label: redo ? `Redo: ${redo} (Ctrl Y)` : "Redo (Ctrl Y)", needs: "drive", run: () => takeBack("redo") },
    ...(served
      ? ([
          { label: recording ? "Stop recording (V)" : "Record every signal (V)", needs: "drive", run: actions.record },
          { label: "Save this run as a scenario (X)", run: actions.saveScenario },
        ] satisfies Tool[])
      : []),
    { label: "Export as a file that runs without a server", needs: "teach", run: actions.exportFile },
    { label: "Fork: a copy of this bench from now on (F)", needs: "branch", run: actions.fork },
    { label: "Keep this moment on the timeline (K)", needs: "teach", run: actions.keep },
    { label: "Share this experiment by a link (Shift S)", needs: "teach", run: actions.share },
    ...show,
  ];
  const page: Tool[] = [
    ...(served
      ? [
          {
            label: narrates ? "Narrator off (Q)" : "Narrator on: describe events in sentences (Q)",
            run: toggleNarrator,
          },
        ]
      : []),
    { label: scheme === "dark" ? "Light theme (D)" : "Dark theme (D)", run: () => themeSwitch.flip() },
    { label: "Keyboard ( ? )", run: actions.keys },
  ];
  return (
    <Menu width={330} position="bottom-end">
      <Menu.Target>
        <Button
          size="compact-md"
          variant="subtle"
          px={6}
          flex="none"
          data-menu="more"
          leftSection={recording && <IconPlayerRecordFilled size={16} color="var(--alarm)" />}
          rightSection={<IconChevronDown size={13} />}
          title={recording ? "Every signal is recorded. More: stop, undo, save, share, layouts" : MORE}
        >
          More
        </Button>
      </Menu.Target>
      <Menu.Dropdown>
        <Items tools={bench.filter(({ needs }) => !needs || may(needs, role))} />
        <Menu.Divider />
        <LayoutItems />
        <Menu.Divider />
        <Items tools={page} />
        {documents && !isInFrame() && (
          <Menu.Item component="a" href="./docs/" target="_blank">
            Documents
          </Menu.Item>
        )}
      </Menu.Dropdown>
    </Menu>
  );
}

const MORE = "Undo, record, save, share; layouts; theme, keys, documents";

const Items = ({ tools }: { tools: Tool[] }) =>
  tools.map(({ label, run }) => (
    <Menu.Item key={label} onClick={run}>
      {label}
    </Menu.Item>
  ));

/** Showing the bench to a class, where there is one; with several, each has a button on its own page. */
function useShow(): Tool[] {
  const { all, again } = useClasses();
  const bench = useBench((s) => s.bench?.id);
  const [group, ...others] = all;
  if (!group || !bench || others.length > 0 || group.shown === bench) return [];
  return [
    {
      label: `Show this bench to all of ${group.name}`,
      needs: "teach",
      run: () => void classes.show(group.id, bench).then(again, showError),
    },
  ];
}
