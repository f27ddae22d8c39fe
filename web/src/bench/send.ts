import { notifications } from "@mantine/notifications";
import { ApiError } from "../api/client";
import { may } from "../api/me";
import type { Bench, Command } from "../api/types";
import { useBench } from "../stream/bench-store";
import { stream } from "../stream/stream";
import { announce } from "./announce";

/** The words for a watcher where others could change something. */
export const WATCHING = "You watch this bench and cannot change it.";

/**
 * Send a command to the bench; a refusal is shown where it happened, with what to do.
 *
 * Resolves to whether it took effect. The status comes before the answer, so `useBench` has the changes of the command.
 */
export async function send(command: Command, said?: string): Promise<boolean> {
  if (!may("drive")) {
    notifications.show({ id: "watching", message: WATCHING, autoClose: 3000 });
    return false;
  }
  try {
    const tick = await stream.client.command(command);
    if (said) announce(`${said}, at tick ${tick}.`);
    return true;
  } catch (error) {
    showError(error);
    return false;
  }
}

export function showError(error: unknown): void {
  if (!(error instanceof ApiError)) throw error;
  const { message, hint, field } = error.body;
  notifications.show({
    color: "alarm",
    title: message,
    message: [field && `Field: ${field}.`, hint].filter(Boolean).join(" "),
    autoClose: 8000,
  });
}

/** The same deed; a refusal is shown. */
export const showing =
  <A extends unknown[]>(deed: (...args: A) => Promise<unknown>) =>
  (...args: A): Promise<void> =>
    deed(...args).then(() => undefined, showError);

/** A deed on the bench of the page; without a bench nothing happens. */
export const onBench = <A extends unknown[]>(deed: (bench: Bench, ...args: A) => Promise<unknown>) =>
  showing(async (...args: A) => {
    const { bench } = useBench.getState();
    if (bench) await deed(bench, ...args);
  });
