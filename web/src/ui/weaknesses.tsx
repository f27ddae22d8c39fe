import type { BlockCard } from "../api/types";
import { Prose } from "./prose";
import styles from "./ui.module.css";

/** The known weaknesses of a block, to be read before the block is trusted. */
export function Weaknesses({ of }: { of: BlockCard | undefined }) {
  return of?.weaknesses.map((weakness) => (
    <p key={weakness} role="note" className={styles.weakness}>
      <b>Known weakness</b> <Prose text={weakness} />
    </p>
  ));
}
