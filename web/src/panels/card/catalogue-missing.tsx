import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { useCatalog } from "../../api/use-catalog";
import { EmptyState } from "../../ui/empty-state";

/** In place of blocks that the page does not have: their title while they load, or a button to ask again. */
export function CatalogueMissing({ loading, children }: { loading: string; children: ReactNode }) {
  const { failed, retry } = useCatalog();
  const again = failed && (
    <Button variant="filled" size="xs" onClick={retry}>
      Ask again
    </Button>
  );
  return (
    <EmptyState title={failed ? "The server did not send the catalogue" : loading} action={again}>
      {children}
    </EmptyState>
  );
}
