import { actions } from "../bench/actions";
import { type PageName, useView } from "../bench/view-store";
import { PAGES } from "./pages";
import styles from "./rail.module.css";

/** The pages, along the left; at the foot of a phone. */
export function Rail() {
  const page = useView((s) => s.page);
  return (
    <nav className={styles.rail} aria-label="Pages">
      {Object.entries(PAGES).map(([id, { name, title, icon, key }]) => (
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
