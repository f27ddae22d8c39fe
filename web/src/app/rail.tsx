import { useMe } from "../api/me";
import { actions } from "../bench/actions";
import { type PageName, useView } from "../bench/view-store";
import { isOffered, PAGES } from "./pages";
import styles from "./rail.module.css";

/** The pages, along the left; at the foot of a phone. */
export function Rail() {
  const page = useView((s) => s.page);
  const role = useMe((s) => s.me?.role);
  const offered = Object.entries(PAGES).filter(([id]) => isOffered(id as PageName, role));
  return (
    <nav className={styles.rail} aria-label="Pages">
      {offered.map(([id, { name, title, icon, key }]) => (
        <button
          key={id}
          type="button"
          title={`${title} (${key.toUpperCase()})`}
          aria-current={id === page ? "page" : undefined}
          onClick={() => id !== page && actions.page(id as PageName)}
        >
          {icon}
          {name}
        </button>
      ))}
    </nav>
  );
}
