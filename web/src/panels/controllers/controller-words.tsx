import type { BlockCard } from "../../api/types";
import { Prose } from "../../ui/prose";
import styles from "./controllers.module.css";

/** A controller by its title, and what it does in a line. */
export function ControllerWords({ law }: { law: Pick<BlockCard, "title" | "summary"> | undefined }) {
  return (
    law && (
      <span className={styles.law}>
        {law.title}
        <small>
          <Prose text={law.summary} />
        </small>
      </span>
    )
  );
}
