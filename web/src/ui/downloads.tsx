import { Anchor, Group } from "@mantine/core";
import styles from "./ui.module.css";

/** Files of one thing in several formats. */
export function Downloads({ href, formats }: { href: (format: string) => string; formats: readonly string[] }) {
  return (
    <Group component="span" className={styles.downloads} display="inline-flex" gap="4px 12px">
      {formats.map((format) => (
        <Anchor
          key={format}
          href={href(format)}
          download
          title={`Download as ${format.toUpperCase()}`}
          c="var(--accent)"
          fz="sm"
          fw={560}
          underline="hover"
        >
          {format.toUpperCase()}
        </Anchor>
      ))}
    </Group>
  );
}

export const TRACE_FORMATS = ["csv", "parquet", "npz", "mat", "mcap"] as const;
