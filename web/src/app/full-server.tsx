import { Button } from "@mantine/core";
import { api } from "../api/api";
import { useAnswer } from "../api/queries";
import { formatCount } from "../ui/format";
import styles from "./full-server.module.css";

const AGAIN_MS = 4000;

interface FullServerProps {
  onJoin(bench: string): void;
  onRetry(): void;
}

/** There is no room for one more bench: which there are, when one goes, and what can be done now. */
export function FullServer({ onJoin, onRetry }: FullServerProps) {
  const { value: benches = [] } = useAnswer(["benches"], api.benches, () => AGAIN_MS);
  const leaving = benches.flatMap((b) => b.let_go_in_s ?? []);
  return (
    <main className={styles.full}>
      <h1>This server has no free bench</h1>
      <p>
        It has {benches.length === 1 ? "one bench" : `${benches.length} benches`}, which is its limit.{" "}
        {leaving.length > 0
          ? `Nobody watches ${leaving.length} of them; the next one is let go in ${formatCount(Math.ceil(Math.min(...leaving) / 60), "minute")}, unless somebody comes back to it.`
          : "All benches are watched or busy. Wait until one is closed, or ask the administrator of the server."}{" "}
        Meanwhile you can join one and watch.
      </p>
      <Button variant="filled" size="sm" onClick={onRetry}>
        Try again
      </Button>
      <ul aria-label="Benches that run">
        {benches.map((b) => (
          <li key={b.id}>
            <div>
              <b>{b.title}</b>
              <small>
                {b.state} · {b.watchers} watching · since{" "}
                {new Date(b.created).toLocaleTimeString([], { timeStyle: "short" })}
              </small>
            </div>
            <Button size="xs" onClick={() => onJoin(b.id)} aria-label={`Join ${b.title}`}>
              Join
            </Button>
          </li>
        ))}
      </ul>
    </main>
  );
}
