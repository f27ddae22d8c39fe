import styles from "./ui.module.css";

/** A signal's name: the block it comes from, then what it is. */
export function SignalName({ name }: { name: string }) {
  const [block, ...rest] = name.split(".");
  return (
    <span className={styles.signal} title={name}>
      <span className={styles.block}>{words(block)}</span> <span data-rest>{words(rest.join(" "))}</span>
    </span>
  );
}

const words = (text: string) => text.replaceAll("_", " ");
