import { Button, type ButtonProps } from "@mantine/core";
import type { ComponentPropsWithRef, ReactNode } from "react";
import styles from "./strip.module.css";

interface StripButtonProps extends ButtonProps, Omit<ComponentPropsWithRef<"button">, keyof ButtonProps> {
  icon: ReactNode;
  label: string;
}

/** A button of the strip: an icon, and its word where there is room. */
export function StripButton({ icon, label, ...rest }: StripButtonProps) {
  return (
    <Button px={6} aria-label={label} title={label} {...rest}>
      {icon}
      <span className={styles.word}>{label}</span>
    </Button>
  );
}
