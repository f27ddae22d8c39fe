import { Box, Button, TextInput } from "@mantine/core";
import { IconCheck, IconCopy } from "@tabler/icons-react";
import { useState } from "react";
import { isLocal } from "../api/classes";
import { announce } from "../bench/announce";
import { copyText } from "../ui/copy-text";
import { QrCode } from "../ui/qr-code";
import styles from "./dialogs.module.css";

interface LinkBoxProps {
  /** Below the address of the page, such as "?link=ab3kmn7x". */
  path: string;
  what: string;
  /** A note for the people who open it. */
  remark?: string;
  onCopy?(): void;
}

const NEEDS_TOKEN = "People who open it must enter the access token of this server once.";

/** A link in full, to be copied or read from the screen by a phone. */
export function LinkBox({ path, what, remark, onCopy }: LinkBoxProps) {
  const address = new URL(`./${path}`, document.baseURI).href;
  const [copied, setCopied] = useState("");

  const copy = async () => {
    onCopy?.();
    await copyText(address);
    setCopied(address);
    announce("Link copied.");
  };

  return (
    <Box mt={12}>
      <div className={styles.name}>
        <TextInput size="sm" label={what} value={address} readOnly onFocus={(e) => e.currentTarget.select()} />
        <Button
          variant="filled"
          size="sm"
          leftSection={copied === address ? <IconCheck size={16} /> : <IconCopy size={16} />}
          onClick={copy}
        >
          {copied === address ? "Copied" : "Copy"}
        </Button>
      </div>
      {isLocal(address) && (
        <p className={styles.remark}>
          Other computers cannot reach this address. Open the page at the address that others use, then share.
        </p>
      )}
      <Box w={240} m="16px auto 8px">
        <QrCode address={address} />
      </Box>
      <p className={styles.remark}>{remark || NEEDS_TOKEN}</p>
    </Box>
  );
}
