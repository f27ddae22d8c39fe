import qrcode from "qrcode-generator";
import { useMemo } from "react";
import styles from "./ui.module.css";

/** An address for a phone to read from the screen, dark on white in both schemes. */
export function QrCode({ address }: { address: string }) {
  const { path, size } = useMemo(() => qrPath(address), [address]);
  return (
    <svg className={styles.qr} viewBox={`0 0 ${size} ${size}`} role="img" aria-label={`QR code of ${address}`}>
      <rect width={size} height={size} fill="#ffffff" />
      <path d={path} fill="#000000" />
    </svg>
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
