import { createSpotlight, Spotlight } from "@mantine/spotlight";
import { IconSearch } from "@tabler/icons-react";
import { type KeyboardEvent as KeyDown, useEffect, useState } from "react";
import { find } from "./find";
import styles from "./search.module.css";
import { useEntries } from "./use-entries";

const [store, spotlight] = createSpotlight();

/** Open the search, from a key or a button. */
export const openSearch = spotlight.open;

/** Whether the search is open, or about to be: the keys of the page are letters for it. */
export const isSearching = (): boolean => store.getState().opened;

/** Finds panels, scenarios, equations, devices, settings and places by their words, and opens them. */
export function Search() {
  const [asked, setAsked] = useState("");
  useEffect(() => {
    // letters that are typed before the field has the keyboard belong to it
    const type = ({ key, target, ctrlKey, metaKey, altKey }: KeyboardEvent) => {
      if (!isSearching() || key.length !== 1 || ctrlKey || metaKey || altKey) return;
      if (!(target as HTMLElement).closest("input")) setAsked((before) => before + key);
    };
    window.addEventListener("keydown", type);
    return () => {
      window.removeEventListener("keydown", type);
      spotlight.close(); // the keys are keys of the page again
    };
  }, []);
  return (
    <Spotlight.Root
      store={store}
      shortcut={null}
      query={asked}
      onQueryChange={setAsked}
      attributes={{ content: { "aria-label": "Search" } }}
      overlayProps={{ blur: 0 }}
      scrollable
      maxHeight="70vh"
    >
      <Spotlight.Search
        aria-label="Search"
        placeholder="Panel, scenario, equation, device, setting or place"
        leftSection={<IconSearch size={18} />}
        onKeyDown={openFirst}
      />
      <Spotlight.ActionsList>
        <Found asked={asked} />
      </Spotlight.ActionsList>
    </Spotlight.Root>
  );
}

/** Enter opens the first entry where none is chosen yet, as after letters that came before the field. */
function openFirst({ key, currentTarget }: KeyDown) {
  const entries = [...(currentTarget.closest("[role=dialog]")?.querySelectorAll<HTMLElement>("[data-action]") ?? [])];
  if (key === "Enter" && !entries.some((entry) => entry.dataset.selected)) entries[0]?.click();
}

function Found({ asked }: { asked: string }) {
  const groups = find(useEntries(), asked);
  if (groups.length === 0) return <Spotlight.Empty>Nothing has all these words.</Spotlight.Empty>;
  return groups.map(([group, entries]) => (
    <Spotlight.ActionsGroup key={group} label={group} role="group" aria-label={group}>
      {entries.map(({ key, title, about, open }) => (
        <Spotlight.Action key={key} className={styles.action} label={title} description={about} onClick={open} />
      ))}
    </Spotlight.ActionsGroup>
  ));
}
