import styles from "./dialogs.module.css";
import { keymap, LOCAL_KEYS } from "./keymap";
import { SideSheet } from "./side-sheet";
import { TourList } from "./tours/tour-list";

/** Every key there is. */
export function KeySheet() {
  return (
    <SideSheet name="keys" title="Keyboard" size={380}>
      {(["Run", "Bench", "Look", "Pages"] as const).map((group) => (
        <Section key={group} title={group} rows={keymap().filter((b) => b.group === group)} />
      ))}
      <Section title="In a panel" rows={LOCAL_KEYS} />
      <TourList />
    </SideSheet>
  );
}

function Section({ title, rows }: { title: string; rows: { shown: string; does: string }[] }) {
  return (
    <>
      <h3 className={styles.heading}>{title}</h3>
      <dl className={styles.keys}>
        {rows.map((row) => (
          <div key={row.shown + row.does}>
            <dt>
              <kbd>{row.shown}</kbd>
            </dt>
            <dd>{row.does}</dd>
          </div>
        ))}
      </dl>
    </>
  );
}
