import { lazy, Suspense } from "react";
import { EmptyState } from "../../ui/empty-state";

const Editor = lazy(() => import("./editor").then(({ Editor }) => ({ default: Editor })));

/** Write a unit of one's own; the editor of texts is loaded when it is opened first. */
export function EditorPanel() {
  return (
    <Suspense fallback={<EmptyState title="Loading the editor">It comes from this server.</EmptyState>}>
      <Editor />
    </Suspense>
  );
}
