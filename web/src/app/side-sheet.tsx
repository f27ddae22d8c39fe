import type { ReactNode } from "react";
import { useView } from "../bench/view-store";
import { Sheet } from "../ui/sheet";

interface SideSheetProps {
  name: Exclude<ReturnType<typeof useView.getState>["dialog"], "none">;
  title: string;
  size: number | string;
  children: ReactNode;
}

/** A sheet of the page, one at a time: the view store knows which is open. */
export function SideSheet({ name, children, ...sheet }: SideSheetProps) {
  const open = useView((s) => s.dialog === name);
  return (
    <Sheet opened={open} onClose={() => useView.setState({ dialog: "none" })} {...sheet}>
      {children}
    </Sheet>
  );
}
