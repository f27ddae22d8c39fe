import { Box, Modal } from "@mantine/core";
import { useEffect } from "react";
import { QrCode } from "../ui/qr-code";
import styles from "./wall.module.css";

interface WallProps {
  opened: boolean;
  name: string;
  code: string;
  address: string;
  onClose(): void;
}

/** The code, the address and nothing else, on the whole screen where the browser lets it; Escape leaves. */
export function Wall({ opened, name, code, address, onClose }: WallProps) {
  useEffect(() => {
    if (!opened) return;
    document.documentElement.requestFullscreen?.().catch(() => undefined);
    // Escape leaves the full screen before the page receives the key
    const changed = () => !document.fullscreenElement && onClose();
    document.addEventListener("fullscreenchange", changed);
    return () => {
      document.removeEventListener("fullscreenchange", changed);
      if (document.fullscreenElement) void document.exitFullscreen();
    };
  }, [opened, onClose]);
  return (
    <Modal
      fullScreen
      opened={opened}
      onClose={onClose}
      title={name}
      closeButtonProps={{ "aria-label": "Leave the wall" }}
      classNames={{ content: "column", body: styles.body }}
      styles={{ title: { fontSize: "var(--size-4)", fontWeight: 650 } }}
      transitionProps={{ duration: 0 }}
    >
      <Box component="p" fz="min(12vw, 36vh)" fw={700} lh={1} style={{ whiteSpace: "nowrap" }}>
        {code}
      </Box>
      <div className={`row ${styles.foot}`}>
        <QrCode address={address} />
        <p>
          Scan, or open <b>{brief(address)}</b> and type the code
        </p>
      </div>
    </Modal>
  );
}

/** The address to type, without the code, which the page asks for. */
export const brief = (address: string): string => address.replace(/^https?:\/\//, "").replace(/\?.*$/, "");
