import { ActionIcon, Button, Group, TextInput } from "@mantine/core";
import { IconCheck, IconLink, IconPencil, IconPresentation, IconTrash } from "@tabler/icons-react";
import { type FormEvent, useState } from "react";
import { api } from "../api/api";
import { classes } from "../api/classes";
import { useMay } from "../api/me";
import { useClasses } from "../api/use-classes";
import { announce } from "../bench/announce";
import { showError, showing } from "../bench/send";
import { useView } from "../bench/view-store";
import styles from "./dialogs.module.css";
import { deleteLayout, ownLayouts, refusal, renameLayout, saveLayout, setLayout, sharedLayout } from "./layouts";
import { LinkBox } from "./link-box";
import { SideSheet } from "./side-sheet";

/** The user's own layouts: save, rename, delete, share. */
export function LayoutSheet() {
  return (
    <SideSheet name="layouts" title="Layouts" size={440}>
      <Layouts />
    </SideSheet>
  );
}

function Layouts() {
  const layout = useView((s) => s.layout);
  const [renaming, setRenaming] = useState<string | undefined>(undefined);
  const [link, setLink] = useState<{ id: string; name: string } | undefined>(undefined);
  const [, setRound] = useState(0);
  const again = () => setRound((n) => n + 1);
  const own = ownLayouts();
  const teaches = useMay("teach");

  const { all } = useClasses();
  const give = (group: string) =>
    classes
      .giveLayout(group, layout, { ...sharedLayout() })
      .then(() => announce(`All have the ${layout} layout now.`))
      .then(() => useView.setState({ dialog: "none" }), showError);

  const share = showing(async () => {
    const made = await api.makeLink({ layout: { ...sharedLayout() }, title: layout, note: "" });
    setLink({ id: made.id, name: layout });
  });

  return (
    <>
      <Name label="Save this layout" button="Save" onName={(name) => saveLayout(name)} />
      <p className={styles.remark}>A saved layout keeps what you move in it from then on. It stays in this browser.</p>
      {own.length > 0 && (
        <ul className={styles.gallery} aria-label="Your layouts">
          {own.map(({ name }) => (
            <li key={name}>
              {renaming === name ? (
                <Name
                  label={`New name of ${name}`}
                  button="Rename"
                  first={name}
                  onName={(next) => {
                    renameLayout(name, next);
                    setRenaming(undefined);
                  }}
                />
              ) : (
                <>
                  <h3>{name}</h3>
                  <Group flex="none" gap={4} wrap="nowrap">
                    <Button size="xs" variant="light" disabled={layout === name} onClick={() => setLayout(name)}>
                      {layout === name ? "Shown" : "Show"}
                    </Button>
                    <ActionIcon aria-label={`Rename ${name}`} onClick={() => setRenaming(name)}>
                      <IconPencil size={16} />
                    </ActionIcon>
                    <ActionIcon
                      aria-label={`Delete ${name}`}
                      onClick={() => {
                        if (!window.confirm(`Delete the layout ${name} for good?`)) return;
                        deleteLayout(name);
                        again();
                      }}
                    >
                      <IconTrash size={16} />
                    </ActionIcon>
                  </Group>
                </>
              )}
            </li>
          ))}
        </ul>
      )}
      {teaches && <h3 className={styles.heading}>Share</h3>}
      {teaches && link && link.name === layout && (
        <LinkBox path={`?layout=${link.id}`} what={`Link of the layout ${link.name}`} />
      )}
      {teaches && link?.name !== layout && (
        <Button size="sm" leftSection={<IconLink size={16} />} onClick={share}>
          Make a link of the {layout} layout
        </Button>
      )}
      {all.map(({ id, name }) => (
        <Button size="sm" key={id} mt="sm" leftSection={<IconPresentation size={16} />} onClick={() => give(id)}>
          Give it to all of {name}
        </Button>
      ))}
    </>
  );
}

interface NameProps {
  label: string;
  button: string;
  first?: string;
  onName(name: string): void;
}

/** A field for the name of a layout; a refusal appears at the field. */
function Name({ label, button, first = "", onName }: NameProps) {
  const [name, setName] = useState(first);
  const [error, setError] = useState<string | undefined>(undefined);
  const give = (event: FormEvent) => {
    event.preventDefault();
    const wrong = name.trim() === first && first ? undefined : refusal(name);
    setError(wrong);
    if (wrong) return;
    onName(name.trim());
    setName("");
  };
  return (
    <form className={styles.name} onSubmit={give}>
      <TextInput
        size="sm"
        label={label}
        value={name}
        error={error}
        autoFocus={first !== ""}
        onChange={(e) => setName(e.currentTarget.value)}
      />
      <Button size="sm" type="submit" variant="light" leftSection={<IconCheck size={16} />}>
        {button}
      </Button>
    </form>
  );
}
