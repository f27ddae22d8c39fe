import { lazy, Suspense } from "react";
import { EmptyState } from "../ui/empty-state";
import { SideSheet } from "./side-sheet";

const Editor = lazy(() => import("../panels/editor/editor").then(({ Editor }) => ({ default: Editor })));

/** The bench keeps more than a third of the page; a narrow page gives all it has. */
const WIDTH = "clamp(min(100vw, 30rem), 62vw, 920px)";

/** The editor of the user's own units, in a wide drawer; its text editor is loaded when it is first opened. */
export function EditorDrawer() {
  return (
    <SideSheet name="editor" title="Editor" size={WIDTH}>
      <Suspense fallback={<EmptyState title="Loading the editor">It comes from this server.</EmptyState>}>
        <Editor />
      </Suspense>
    </SideSheet>
  );
}
