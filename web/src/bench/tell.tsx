import { Button } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { isServed } from "../api/me";
import type { Command } from "../api/types";
import { useBench } from "../stream/bench-store";
import { send } from "./send";

/** Send a command that removes something, and offer to undo it. */
export async function sendAndTell(command: Command, said: string): Promise<void> {
  if (!(await send(command, said))) return;
  const canUndo = isServed() || useBench.getState().bench?.undo;
  tellUndoable(said, canUndo ? () => send({ kind: "undo" }, `Undone: ${said}`) : undefined);
}

/** Show a notice of an action, with an Undo button if it can be undone; it replaces the previous such notice. */
export function tellUndoable(said: string, undo?: () => unknown): void {
  if (useBench.getState().blind) return; // Undo would tell the hidden fault
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
