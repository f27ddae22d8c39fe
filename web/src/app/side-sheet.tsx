import { Drawer } from "@mantine/core";
import type { ReactNode } from "react";
import { useView } from "../bench/view-store";

interface SideSheetProps {
  name: Exclude<ReturnType<typeof useView.getState>["dialog"], "none">;
  title: string;
  size: number;
  children: ReactNode;
}

/** Something to read or choose beside the running bench: it covers little and stops nothing. */
export function SideSheet({ name, title, size, children }: SideSheetProps) {
  const open = useView((s) => s.dialog === name);
  return (
    <Drawer
      opened={open}
      onClose={() => useView.setState({ dialog: "none" })}
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
