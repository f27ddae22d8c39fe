import { units } from "../api/units";
import { useBench } from "../stream/bench-store";
import { showError } from "./send";
import { beginWith } from "./unit-draft";
import { sourceOnBench } from "./unit-values";
import { setPage, useView } from "./view-store";

/** Open the editor, a drawer over the bench. */
export function openEditor(): void {
  setPage("bench");
  useView.setState({ dialog: "editor" });
}

/** Begin with a copy of a unit of the library, under a name of its own, or with one this server keeps. */
export async function editCopy(name: string): Promise<void> {
  try {
    const { source, origin } = await units.text(name);
    beginWith(origin === "library" ? `my_${name}`.slice(0, 32) : name, source);
    openEditor();
  } catch (error) {
    showError(error);
  }
}

/** Edit a unit as it is on the bench. */
export function editOwn(name: string): void {
  const source = sourceOnBench(useBench.getState().bench?.parameters, name);
  if (source === undefined) return;
  beginWith(name, source);
  openEditor();
}
