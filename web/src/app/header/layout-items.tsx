import { Menu } from "@mantine/core";
import { type LayoutName, useView } from "../../bench/view-store";
import { setLayout } from "../layouts";
import { togglePresent } from "../present";
import styles from "./header.module.css";

const LAYOUTS: [LayoutName, string][] = [
  ["lecture", "Scope, lanes, faults and 3D in large type (1)"],
  ["lab", "Bench and faults beside the scopes (2)"],
  ["research", "Everything (3)"],
];

/** The built-in layouts and the view for an audience, as items of a menu. */
export function LayoutItems() {
  const layout = useView((s) => s.layout);
  const items = LAYOUTS.map(([name, what]) => (
    <Menu.Item
      key={name}
      aria-current={name === layout}
      fw={name === layout ? 650 : undefined}
      onClick={() => setLayout(name)}
    >
      {name.charAt(0).toUpperCase() + name.slice(1)} layout
      <small className={styles.menuNote}>{what}</small>
    </Menu.Item>
  ));
  return (
    <>
      {items}
      <Menu.Divider />
      <Menu.Item onClick={togglePresent}>
        Present
        <small className={styles.menuNote}>Panels only, on the whole screen (P); Escape leaves</small>
      </Menu.Item>
    </>
  );
}
