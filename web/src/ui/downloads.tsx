import styles from "./ui.module.css";

/** Files of one thing in several formats. */
export function Downloads({ href, formats }: { href: (format: string) => string; formats: readonly string[] }) {
  return (
    <span className={styles.downloads}>
      {formats.map((format) => (
        <a key={format} href={href(format)} download title={`Download as ${format.toUpperCase()}`}>
          {format.toUpperCase()}
        </a>
      ))}
    </span>
  );
}

export const TRACE_FORMATS = ["csv", "parquet", "npz", "mat"] as const;
