import { Box, Button, Drawer, Group } from "@mantine/core";
import { IconShare2 } from "@tabler/icons-react";
import { useShallow } from "zustand/react/shallow";
import { useMay } from "../api/me";
import { actions } from "../bench/actions";
import type { ViewName } from "../bench/panel-views";
import { useView } from "../bench/view-store";
import { useBench } from "../stream/bench-store";
import { PANELS, panelsOn, VIEW, viewsOn } from "./panels";
import styles from "./phone.module.css";
import { Rail } from "./rail";

const BUTTON = { size: "sm", px: 12, fw: 500 };

/** Every panel with a line of words and its views, and the other pages. */
export function PhoneMore({ opened, onClose }: { opened: boolean; onClose(): void }) {
  const axes = useBench(useShallow((s) => s.bench?.axes));
  const teaches = useMay("teach");
  const bench = axes && { axes };
  const show = (view: ViewName) => {
    useView.setState({ extra: view });
    onClose();
  };
  const panels = panelsOn(bench).map((panel) => ({
    ...PANELS[panel],
    views: viewsOn(panel, bench).filter((view) => view !== "time"), // the scope is always in sight
  }));
  return (
    <Drawer
      opened={opened}
      onClose={onClose}
      position="bottom"
      size="100%"
      title="Panels"
      closeButtonProps={{ "aria-label": "Close" }}
      classNames={{ content: "column", body: `column ${styles.body}` }}
    >
      <ul className={styles.list}>
        {panels.map(({ title, about, views }) => (
          <li key={title}>
            <h2>{title}</h2>
            <Box component="p" className="note" mb={6}>
              {about}
            </Box>
            <Group gap={6}>
              {views.map((view) => (
                <Button key={view} {...BUTTON} data-view={view} onClick={() => show(view)}>
                  {VIEW[view].title}
                </Button>
              ))}
            </Group>
          </li>
        ))}
        {teaches && (
          <li>
            <Button {...BUTTON} leftSection={<IconShare2 size={16} />} onClick={actions.share}>
              Share this experiment by a link
            </Button>
          </li>
        )}
      </ul>
      <Rail />
    </Drawer>
  );
}
