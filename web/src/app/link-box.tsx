import { Button, TextInput } from "@mantine/core";
import { IconCheck, IconCopy } from "@tabler/icons-react";
import qrcode from "qrcode-generator";
import { useMemo, useRef, useState } from "react";
import { announce } from "../bench/announce";
import styles from "./dialogs.module.css";

const LOCAL = /^(localhost|127(\.\d+){3}|\[::1\])$/;

interface LinkBoxProps {
  /** What the address of the page is given, such as "link=ab3kmn7x". */
  query: string;
  what: string;
  onCopy?(): void;
}

/** A link in full, to be copied or read from the screen by a phone. */
export function LinkBox({ query, what, onCopy }: LinkBoxProps) {
  const address = new URL(`./?${query}`, document.baseURI).href;
  const qr = useMemo(() => qrPath(address), [address]);
  const field = useRef<HTMLInputElement>(null);
  const [copied, setCopied] = useState("");

  const copy = async () => {
    onCopy?.();
    try {
      await navigator.clipboard.writeText(address);
    } catch {
      // without TLS a browser has no clipboard for pages but on this machine
      field.current?.select();
      document.execCommand("copy");
    }
    setCopied(address);
    announce("Link copied.");
  };

  return (
    <div className={styles.link}>
      <div className={styles.name}>
        <TextInput ref={field} label={what} value={address} readOnly onFocus={(e) => e.currentTarget.select()} />
        <Button leftSection={copied === address ? <IconCheck size={16} /> : <IconCopy size={16} />} onClick={copy}>
          {copied === address ? "Copied" : "Copy"}
        </Button>
      </div>
      {LOCAL.test(window.location.hostname) && (
        <p className={styles.remark}>
          Other computers cannot reach this address. Open the page at the address that others use, then share.
        </p>
      )}
      <svg className={styles.qr} viewBox={`0 0 ${qr.size} ${qr.size}`} role="img" aria-label={`QR code of ${address}`}>
        <rect width={qr.size} height={qr.size} fill="#ffffff" />
        <path d={qr.path} fill="#000000" />
      </svg>
      <p className={styles.remark}>Whoever opens it must enter the access token of this server once.</p>
    </div>
  );
}

/** Light modules around a code, as the standard wants them. */
const QUIET = 4;

/** The dark modules of a QR code as one path, in a square of so many modules, its quiet zone included. */
export function qrPath(text: string): { path: string; size: number } {
  const code = qrcode(0, "M");
  code.addData(text);
  code.make();
  const count = code.getModuleCount();
  let path = "";
  for (let row = 0; row < count; row += 1)
    for (let column = 0; column < count; column += 1)
      if (code.isDark(row, column)) path += `M${column + QUIET} ${row + QUIET}h1v1h-1z`;
  return { path, size: count + 2 * QUIET };
}
