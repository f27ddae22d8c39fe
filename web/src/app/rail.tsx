import { IconSearch } from "@tabler/icons-react";
import { useMe, useServed } from "../api/me";
import type { PageName } from "../bench/places";
import { setPage, useView } from "../bench/view-store";
import { isOffered, PAGES } from "./pages";
import styles from "./rail.module.css";
import { openSearch } from "./search/search";

/** The pages, along the left; at the foot of a phone. */
export function Rail() {
  const page = useView((s) => (s.lost ? undefined : (PAGES[s.page].tabOf ?? s.page)));
  const role = useMe((s) => s.me?.role);
  const served = useServed();
  const offered = Object.entries(PAGES).filter(([id, { tabOf }]) => !tabOf && isOffered(id as PageName, role));
  if (!served) return null; // the bench is the only page
  return (
    <nav className={`column ${styles.rail}`} aria-label="Pages">
      <button type="button" className="bar-button" title="Search (Ctrl K)" onClick={openSearch}>
        <IconSearch size={21} />
        Search
      </button>
      {offered.map(([id, { name, title, icon, key }]) => (
        <button
          key={id}
          type="button"
          className="bar-button"
          title={`${title} (${key.toUpperCase()})`}
          aria-current={id === page ? "page" : undefined}
          onClick={() => setPage(id as PageName)}
        >
          {icon}
          {name}
        </button>
      ))}
    </nav>
  );
}
