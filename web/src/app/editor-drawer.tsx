import { lazy, Suspense } from "react";
import { EmptyState } from "../ui/empty-state";
import { SideSheet } from "./side-sheet";

const Editor = lazy(() => import("../panels/editor/editor").then(({ Editor }) => ({ default: Editor })));

const WIDTH = 920;

/** The editor of units of one's own, in a wide drawer; the editor of texts is loaded when it is opened first. */
export function EditorDrawer() {
  return (
    <SideSheet name="editor" title="Editor" size={WIDTH}>
      <Suspense fallback={<EmptyState title="Loading the editor">It comes from this server.</EmptyState>}>
        <Editor />
      </Suspense>
    </SideSheet>
  );
}
