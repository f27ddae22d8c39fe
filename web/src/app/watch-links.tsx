import { Button, NumberInput } from "@mantine/core";
import { IconEye } from "@tabler/icons-react";
import { useState } from "react";
import { classes } from "../api/classes";
import { useAnswer } from "../api/queries";
import { showError } from "../bench/send";
import { useBusy } from "../bench/use-busy";
import styles from "./dialogs.module.css";

const USUAL_H = 4;
const LONGEST_H = 24 * 14;

interface WatchLinksProps {
  bench: string;
  /** The id of the link by which people watch. */
  link: string;
  /** Called with the path by which people without the access token watch, and without one when that ends. */
  onLet(path: string): void;
}

/** Lets people without the access token watch a bench by a link; that ends by itself, or here. */
export function WatchLinks({ bench, link, onLet }: WatchLinksProps) {
  const { value: watchers, again } = useAnswer(["watchers", bench], () => classes.watchers(bench));
  const [hours, setHours] = useState<number | string>(USUAL_H);
  const [busy, during] = useBusy();
  const [own, setOwn] = useState("");
  const isRight = Number(hours) > 0 && Number(hours) <= LONGEST_H;
  const letWatch = () =>
    during(async () => {
      const { id, path } = await classes.letWatch(bench, link, Number(hours));
      setOwn(id);
      onLet(path ?? "");
      again();
    });
  const end = async (id: string) => {
    if (id === own) onLet("");
    await classes.endWatching(bench, id).then(again, showError);
  };
  return (
    <section aria-label="Watch by the link">
      <h3 className={styles.heading}>Let people watch</h3>
      <p className={styles.remark}>
        People without the access token can open the link too: they see this bench live and cannot change it.
      </p>
      <div className={styles.name}>
        <NumberInput
          size="sm"
          label="Lasts, hours"
          min={0.1}
          max={LONGEST_H}
          value={hours}
          onChange={setHours}
          error={isRight ? undefined : `More than 0, at most ${LONGEST_H}`}
        />
        <Button size="sm" leftSection={<IconEye size={16} />} loading={busy} disabled={!isRight} onClick={letWatch}>
          Let people watch
        </Button>
      </div>
      {watchers && watchers.length > 0 && (
        <ul className={styles.gallery} aria-label="Links by which people watch this bench">
          {watchers.map(({ id, until }) => (
            <li key={id}>
              <span>Lasts until {new Date(until).toLocaleString([], { dateStyle: "short", timeStyle: "short" })}</span>
              <Button onClick={() => void end(id)}>End</Button>
            </li>
          ))}
        </ul>
      )}
    </section>
  );
}
