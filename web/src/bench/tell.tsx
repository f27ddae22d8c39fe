import { Button } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import type { Command } from "../api/types";
import { useBench } from "../stream/bench-store";
import { send } from "./send";

/** Send a command that takes something away, and say so with the way back beside it. */
export async function sendAndTell(command: Command, said: string): Promise<void> {
  if (await send(command, said)) tellUndoable(said, () => send({ kind: "undo" }, `Undone: ${said}`));
}

/** Say what was done, with a button that takes it back if there is a way; the newest such notice takes the place of the one before. */
export function tellUndoable(said: string, undo?: () => unknown): void {
  if (useBench.getState().blind) return; // the way back would tell what acts
  const id = "undoable";
  notifications.hide(id);
  notifications.show({
    id,
    autoClose: 8000,
    message: (
      <span style={{ display: "flex", alignItems: "center", gap: 12 }}>
        {said}
        {undo && (
          <Button
            onClick={() => {
              notifications.hide(id);
              undo();
            }}
          >
            Undo
          </Button>
        )}
      </span>
    ),
  });
}
