import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { View3dFrame } from "./view3d-frame";

/** The shuttle in 3D, if this server draws it. */
export function View3dPanel() {
  const path = useBench((s) => s.bench?.view3d);
  if (path === undefined) return <EmptyState title="No bench yet">The device appears here in 3D.</EmptyState>;
  if (path === null)
    return <EmptyState title="No 3D view">This server runs without it; everything else works.</EmptyState>;
  return <View3dFrame key={path} path={`.${path}`} />;
}
