import { Drawer } from "@mantine/core";
import { type ReactNode, useLayoutEffect, useRef } from "react";

interface SheetProps {
  opened: boolean;
  title: string;
  size: number | string;
  onClose(): void;
  children: ReactNode;
}

/** A drawer to read or choose in while the bench runs: it covers little of the page. */
export function Sheet({ opened, title, size, onClose, children }: SheetProps) {
  const before = useRef<Element | null>(null);
  // On a busy machine the drawer may take the focus late, after it was closed, and would not give it back.
  useLayoutEffect(() => {
    if (opened) before.current = document.activeElement;
  }, [opened]);
  const giveFocusBack = () => {
    const { activeElement, body } = document;
    const isLost = activeElement === body || activeElement?.closest("[role=dialog]");
    if (isLost && before.current instanceof HTMLElement) before.current.focus({ preventScroll: true });
  };
  return (
    <Drawer
      opened={opened}
      onClose={onClose}
      onExitTransitionEnd={giveFocusBack}
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
