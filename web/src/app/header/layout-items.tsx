import { Menu } from "@mantine/core";
import { type LayoutName, useView } from "../../bench/view-store";
import { FROM_LINK, FROM_TEACHER, isBuiltIn, ownLayouts, resetLayout, setLayout } from "../layouts";
import { togglePresent } from "../present";

const BUILT_IN: [LayoutName, string][] = [
  ["lecture", "Scope, lanes, faults and 3D in large type (1)"],
  ["lab", "Bench and faults beside the scopes (2)"],
  ["research", "Everything (3)"],
];

/** The built-in layouts and the user's own, as items of a menu. */
export function LayoutItems() {
  const layout = useView((s) => s.layout);
  const own = ownLayouts().map(({ name }) => name);
  return (
    <>
      {BUILT_IN.map(([name, what]) => (
        <Item key={name} name={name} title={`${name.charAt(0).toUpperCase() + name.slice(1)} layout`} what={what} />
      ))}
      {own.map((name) => (
        <Item key={name} name={name} title={name} what="yours" />
      ))}
      {layout === FROM_LINK && (
        <Item name={FROM_LINK} title="Layout of the link" what="until you save it or choose another" />
      )}
      {layout === FROM_TEACHER && (
        <Item name={FROM_TEACHER} title="Layout of your teacher" what="until you save it or choose another" />
      )}
      <Menu.Divider />
      {isBuiltIn(layout) && <Menu.Item onClick={resetLayout}>Reset the {layout} layout</Menu.Item>}
      <Menu.Item onClick={() => useView.setState({ dialog: "layouts" })}>Save, rename or share a layout…</Menu.Item>
      <Menu.Item onClick={togglePresent}>
        Present
        <small>Panels only, on the whole screen (P); Escape leaves</small>
      </Menu.Item>
    </>
  );
}

function Item({ name, title, what }: { name: string; title: string; what: string }) {
  const isHere = useView((s) => s.layout === name);
  return (
    <Menu.Item aria-current={isHere} fw={isHere ? 650 : undefined} onClick={() => !isHere && setLayout(name)}>
      {title}
      <small>{what}</small>
    </Menu.Item>
  );
}
