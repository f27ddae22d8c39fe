import { Button, NativeSelect } from "@mantine/core";
import { useState } from "react";
import { classes } from "../api/classes";
import { useAnswer } from "../api/queries";
import { EmptyState } from "../ui/empty-state";
import { Stale } from "../ui/stale";
import { ClassView } from "./class-view";
import { OpenClass } from "./open-class";

const EVERY_MS = 5000;

/** The classes of this server, one at a time; without a class, the form that opens one. */
export function ClassPage() {
  const { value: all, error, since, again } = useAnswer(["classes"], classes.all, () => EVERY_MS);
  const [wanted, setWanted] = useState<string | undefined>(undefined);
  const [another, setAnother] = useState(false);
  const group = all?.find(({ id }) => id === wanted) ?? all?.at(-1);
  const opened = ({ id }: { id: string }) => {
    setWanted(id);
    setAnother(false);
    again();
  };
  return (
    <main className="paper">
      <Stale error={error} since={since} onRetry={again} />
      {!all ? (
        !error && <EmptyState title="Asking the server">A class and its students appear here.</EmptyState>
      ) : !group || another ? (
        <OpenClass onOpened={opened} onCancel={group ? () => setAnother(false) : undefined} />
      ) : (
        <ClassView key={group.id} group={group} onChanged={again}>
          {all.length > 1 && (
            <NativeSelect
              aria-label="Class"
              value={group.id}
              data={all.map(({ id, name }) => ({ value: id, label: name }))}
              onChange={(e) => setWanted(e.currentTarget.value)}
            />
          )}
          <Button size="xs" onClick={() => setAnother(true)}>
            Another class
          </Button>
        </ClassView>
      )}
    </main>
  );
}
