import { Button } from "@mantine/core";

/** The end of a list with further rows: a button that shows more of them. */
export function ShowOlder({ more }: { more: (() => void) | undefined }) {
  return (
    more && (
      <Button size="xs" m={8} onClick={more}>
        Show older
      </Button>
    )
  );
}
