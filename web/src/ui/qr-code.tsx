import { api } from "../api/api";
import { useAnswer } from "../api/queries";
import styles from "./ui.module.css";

/** An address for a phone to read from the screen, dark on white in both schemes. */
export function QrCode({ address }: { address: string }) {
  const { value } = useAnswer(["qr", address], () => api.qrCode(address));
  return <img className={styles.qr} src={value?.image} alt={`QR code of ${address}`} />;
}
