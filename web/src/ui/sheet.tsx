import { Drawer } from "@mantine/core";
import type { ReactNode } from "react";

interface SheetProps {
  opened: boolean;
  title: string;
  size: number | string;
  onClose(): void;
  children: ReactNode;
}

/** A drawer to read or choose in while the bench runs: it covers little of the page. */
export function Sheet({ opened, title, size, onClose, children }: SheetProps) {
  return (
    <Drawer
      opened={opened}
      onClose={onClose}
      title={title}
      position="right"
      size={size}
      withOverlay={false}
      lockScroll={false}
      closeButtonProps={{ "aria-label": "Close" }}
      styles={{
        content: { borderLeft: "1px solid var(--line)", boxShadow: "var(--shadow)" },
        title: { fontWeight: 650, fontSize: "var(--size-3)" },
      }}
    >
      {children}
    </Drawer>
  );
}
