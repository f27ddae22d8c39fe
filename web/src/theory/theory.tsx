import { Button } from "@mantine/core";
import { IconArrowLeft } from "@tabler/icons-react";
import { setPage } from "../app/view-store";
import { Excitation } from "./excitation";
import { Instability } from "./instability";
import { PositiveReal } from "./positive-real";
import styles from "./theory.module.css";

/** What can be said of a system before anything is run: appendices A and B. */
export function Theory() {
  return (
    <main className={styles.page}>
      <header className={styles.top}>
        <Button size="xs" variant="subtle" leftSection={<IconArrowLeft size={16} />} onClick={() => setPage("bench")}>
          Bench
        </Button>
        <h1>Theory</h1>
      </header>
      <div className={styles.cards}>
        <PositiveReal />
        <Excitation />
        <Instability />
      </div>
    </main>
  );
}
