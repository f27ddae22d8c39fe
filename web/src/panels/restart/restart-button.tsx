import { Button, type ButtonProps } from "@mantine/core";
import { useMay } from "../../api/me";
import { openVariant } from "../../bench/open-bench";
import { useBusy } from "../../bench/use-busy";

interface RestartButtonProps extends ButtonProps {
  /** Values that the new bench has instead. */
  set: Record<string, unknown>;
  /** The announcement once the new bench is shown. */
  said: string;
}

/** Begin the bench again with other values; only a teacher sees it. */
export function RestartButton({ set, said, ...look }: RestartButtonProps) {
  const [busy, during] = useBusy();
  if (!useMay("teach")) return null;
  return <Button {...look} loading={busy} onClick={() => void during(() => openVariant(set, said))} />;
}
