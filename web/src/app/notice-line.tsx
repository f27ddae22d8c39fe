import { Group } from "@mantine/core";
import type { ReactNode } from "react";
import styles from "./banner.module.css";

interface NoticeLineProps {
  label: string;
  tone?: "note" | "warn" | "alarm";
  title: string;
  text?: string;
  /** A phone shows the title alone. */
  isBrief?: boolean;
  children?: ReactNode;
}

/** A line under the header: a title, a sentence, and buttons at its end. */
export function NoticeLine({ label, tone = "note", title, text, isBrief, children }: NoticeLineProps) {
  return (
    <section className={`row ${styles.banner}`} data-tone={tone} data-brief={isBrief} aria-label={label}>
      {title && <strong>{title}</strong>}
      {text && <span>{text}</span>}
      <Group gap={8} ml="auto" wrap="nowrap">
        {children}
      </Group>
    </section>
  );
}
