import { units } from "../api/units";
import { useBench } from "../stream/bench-store";
import { showing } from "./send";
import { beginWith, nameOfClass } from "./unit-draft";
import { sourceOnBench } from "./unit-values";
import { setPage, useView } from "./view-store";

/** Open the editor, a drawer over the bench. */
export function openEditor(): void {
  setPage("bench");
  useView.setState({ dialog: "editor" });
}

/** Begin with a copy of a unit of the library, under a name of its own; with a starter, named as its class; or with a unit of the server. */
export const editCopy = showing(async (name: string) => {
  const { source, origin } = await units.text(name);
  const own = origin === "library" ? `my_${name}`.slice(0, 32) : origin === "starter" ? nameOfClass(source) : name;
  beginWith(own, source);
  openEditor();
});

/** Edit a unit as it is on the bench. */
export function editOwn(name: string): void {
  const source = sourceOnBench(useBench.getState().bench?.parameters, name);
  if (source === undefined) return;
  beginWith(name, source);
  openEditor();
}
