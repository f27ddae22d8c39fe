import { Button } from "@mantine/core";
import type { ApiError } from "../api/client";

interface StaleProps {
  error: ApiError | undefined;
  /** When what is shown was true. */
  since: Date | undefined;
  onRetry(): void;
}

/** Says that the server has not answered, how old what is shown is, and asks again. */
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
