import { Button } from "@mantine/core";
import type { ApiError } from "../api/client";

interface StaleProps {
  error: ApiError | undefined;
  /** The time of the data on the page. */
  since: Date | undefined;
  onRetry(): void;
}

/** A notice that the server has not answered, with the age of the data and a button to ask again. */
export function Stale({ error, since, onRetry }: StaleProps) {
  if (!error) return null;
  return (
    <p className="row wrong" role="alert">
      {error.body.message} {since && `What you see is of ${since.toLocaleTimeString()}.`} {error.body.hint}
      <Button size="compact-xs" onClick={onRetry}>
        Ask again
      </Button>
    </p>
  );
}
