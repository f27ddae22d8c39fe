import { Box, Tabs } from "@mantine/core";
import type { ReactNode } from "react";
import styles from "./page-tabs.module.css";

interface PageTab {
  title: string;
  body: ReactNode;
}

/** A page of several tabs; the first is shown unless another is named. */
export function PageTabs({
  title,
  tabs,
  shown,
  onShow,
}: {
  title: string;
  tabs: Record<string, PageTab>;
  shown: string | undefined;
  onShow(tab: string): void;
}) {
  const [first] = Object.keys(tabs);
  const value = shown && shown in tabs ? shown : first;
  return (
    <Box component="main" display="flex" mih={0}>
      <Tabs
        value={value}
        onChange={(next) => next && onShow(next)}
        keepMounted={false}
        className="column"
        flex={1}
        miw={0}
        mih={0}
        classNames={{ list: styles.list, panel: styles.panel }}
      >
        <header className={`row ${styles.top}`}>
          <Tabs.List aria-label={title}>
            {Object.entries(tabs).map(([id, tab]) => (
              <Tabs.Tab key={id} value={id}>
                {tab.title}
              </Tabs.Tab>
            ))}
          </Tabs.List>
        </header>
        <Tabs.Panel value={value}>{tabs[value].body}</Tabs.Panel>
      </Tabs>
    </Box>
  );
}
