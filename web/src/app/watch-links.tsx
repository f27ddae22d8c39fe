import { Button, NumberInput } from "@mantine/core";
import { IconEye } from "@tabler/icons-react";
import { useState } from "react";
import { classes } from "../api/classes";
import { useAnswer } from "../api/queries";
import { showError } from "../bench/send";
import styles from "./dialogs.module.css";
import { LinkBox } from "./link-box";

const USUAL_H = 4;
const LONGEST_H = 24 * 14;

/** Links by which others see a bench live and change nothing; each ends by itself, or here. */
export function WatchLinks({ bench }: { bench: string }) {
  const { value: links, again } = useAnswer(["watchers", bench], () => classes.watchers(bench));
  const [hours, setHours] = useState<number | string>(USUAL_H);
  const [path, setPath] = useState<{ of: string; path: string } | undefined>(undefined);
  const [busy, setBusy] = useState(false);
  const make = async () => {
    setBusy(true);
    try {
      const made = await classes.letWatch(bench, Number(hours));
      setPath(made.path ? { of: made.id, path: made.path } : undefined);
      again();
    } catch (error) {
      showError(error);
    } finally {
      setBusy(false);
    }
  };
  const end = async (id: string) => {
    if (path?.of === id) setPath(undefined);
    await classes.endWatching(bench, id).then(again, showError);
  };
  return (
    <section aria-label="Link to watch">
      <h3 className={styles.heading}>Link to watch</h3>
      <p className={styles.remark}>People who open it see this bench live. They cannot change anything.</p>
      <div className={styles.name}>
        <NumberInput
          label="Lasts, hours"
          min={0.1}
          max={LONGEST_H}
          value={hours}
          onChange={setHours}
          error={Number(hours) > 0 && Number(hours) <= LONGEST_H ? undefined : `More than 0, at most ${LONGEST_H}`}
        />
        <Button
          variant="default"
          leftSection={<IconEye size={16} />}
          loading={busy}
          disabled={!(Number(hours) > 0 && Number(hours) <= LONGEST_H)}
          onClick={make}
        >
          Make a link
        </Button>
      </div>
      {path && (
        <LinkBox
          path={path.path.slice(1)}
          what="Address to watch"
          remark="It needs no access token, and is shown only now: copy it."
        />
      )}
      {links && links.length > 0 && (
        <ul className={styles.gallery} aria-label="Links to watch this bench">
          {links.map(({ id, until }) => (
            <li key={id}>
              <span>Lasts until {new Date(until).toLocaleString([], { dateStyle: "short", timeStyle: "short" })}</span>
              <Button size="compact-sm" variant="default" onClick={() => end(id)}>
                End
              </Button>
            </li>
          ))}
        </ul>
      )}
    </section>
  );
}
