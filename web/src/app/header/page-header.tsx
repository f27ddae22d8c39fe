import { Box, Button } from "@mantine/core";
import { IconArrowLeft } from "@tabler/icons-react";
import { setPage } from "../../bench/view-store";
import { useBench } from "../../stream/bench-store";
import styles from "./header.module.css";
import { StateBadge } from "./state-badge";
import { Visitor } from "./visitor";

/** The strip along the top of the other pages: the bench by its name and state, and the way back to it. */
export function PageHeader() {
  const title = useBench((s) => s.bench?.title);
  return (
    <header className={`${styles.header} ${styles.plain}`}>
      <img src="./comb.svg" alt="" width="22" height="22" />
      <h1 className={styles.title}>CombBench</h1>
      <Button leftSection={<IconArrowLeft size={15} />} onClick={() => setPage("bench")}>
        Back to the bench
      </Button>
      <Box component="strong" className="cut" fw={560}>
        {title ?? "No bench"}
      </Box>
      <StateBadge />
      <Visitor />
    </header>
  );
}
