import { Button, FileButton, Menu, NativeSelect } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import type { Answer } from "../../api/queries";
import type { CheckedUnit, UnitEntry } from "../../api/types";
import { units } from "../../api/units";
import { editCopy } from "../../bench/edit-unit";
import { showError } from "../../bench/send";
import { beginWith, isUnitName, useDraft } from "../../bench/unit-draft";
import { saveFile } from "../../ui/save-file";

interface StartFromProps {
  list: Answer<{ units: UnitEntry[] }>;
  /** The unit of the text of now, if it passes. */
  unit: CheckedUnit | undefined;
}

const FAMILIES: Record<string, string> = {
  control: "Controllers",
  diagnose: "Diagnosers",
  identify: "Identifiers",
  reference: "References",
  sense: "Sensors",
  faults: "Faults",
};

/** Sources and places of a text: the library, files, the folder of this server. */
export function StartFrom({ list, unit }: StartFromProps) {
  const { name, source } = useDraft();
  const all = list.value?.units ?? [];
  const isKept = all.some((one) => one.origin === "folder" && one.name === name);
  const groups = [
    { group: "To begin with", items: all.filter((one) => one.origin === "starter") },
    { group: "On this server", items: all.filter((one) => one.origin === "folder" || one.origin === "command line") },
    ...Object.entries(FAMILIES).map(([family, group]) => ({
      group,
      items: all.filter((one) => one.origin === "library" && one.family === family),
    })),
  ];
  const open = async (file: File | null) => {
    if (!file) return;
    const stem = file.name.replace(/\.py$/, "").toLowerCase();
    beginWith(isUnitName(stem) ? stem : "", await file.text());
  };
  const told = (title: string, done: Promise<unknown>) =>
    done
      .then(() => notifications.show({ title, message: "Every new bench of this server." }), showError)
      .then(list.again);
  return (
    <>
      <NativeSelect
        w="20ch"
        aria-label="Start from"
        value=""
        data={[
          { value: "", label: "Start from…" },
          ...groups
            .filter(({ items }) => items.length > 0)
            .map(({ group, items }) => ({
              group,
              items: items.map((one) => ({ value: one.name, label: one.title })),
            })),
        ]}
        onChange={(e) => e.currentTarget.value && void editCopy(e.currentTarget.value)}
      />
      <Menu position="bottom-start">
        <Menu.Target>
          <Button size="xs">File</Button>
        </Menu.Target>
        <Menu.Dropdown>
          <FileButton accept=".py,text/x-python" onChange={(file) => void open(file)}>
            {(props) => <Menu.Item {...props}>Open a file…</Menu.Item>}
          </FileButton>
          <Menu.Item
            disabled={!source}
            onClick={() => saveFile(`${name || "unit"}.py`, new Blob([source], { type: "text/x-python" }))}
          >
            Save as a file
          </Menu.Item>
          <Menu.Divider />
          <Menu.Item
            disabled={!unit || !isUnitName(name)}
            onClick={() => void told(`${name} is kept on this server`, units.keep(name, source))}
          >
            Keep on this server
          </Menu.Item>
          {isKept && (
            <Menu.Item onClick={() => void told(`${name} is deleted from this server`, units.remove(name))}>
              Delete from this server
            </Menu.Item>
          )}
          <Menu.Divider />
          <Menu.Item disabled={!source} onClick={() => beginWith("", "")}>
            Empty the editor
          </Menu.Item>
        </Menu.Dropdown>
      </Menu>
    </>
  );
}
