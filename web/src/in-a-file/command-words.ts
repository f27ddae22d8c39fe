import type { FileCommand } from "./file-document";

/** A command in words, as the log has it. */
export function commandWords(command: FileCommand): string {
  if ("fault" in command) return `inject ${command.fault} ${command.severity < 0 ? "" : "+"}${command.severity}`;
  if ("heal" in command) return `heal ${command.heal === "all" ? "all" : command.heal.join(", ")}`;
  if ("switch" in command) return `switch to ${command.switch}${command.cold ? " from a cold start" : ""}`;
  if ("set" in command) return `set ${valueWords(command.set)}`;
  return "reset after the trip";
}

/** Values in words: "reference.amplitude_v = 5". */
export const valueWords = (values: Record<string, unknown>): string =>
  Object.entries(values)
    .map(([path, value]) => `${path} = ${value}`)
    .join(", ");
