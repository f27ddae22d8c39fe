import { useEffect, useRef } from "react";
import { useServed } from "../../api/me";
import { usePanelVisible } from "../../api/panel-visible";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { useOnScreen } from "../../ui/on-screen";
import { PlanView } from "./plan-view";
import styles from "./view3d.module.css";
import { View3dFrame } from "./view3d-frame";
import { offerPlace, usePlaces } from "./view3d-host";
import { useWebgl } from "./webgl";

/** The device in 3D, if this server draws it: the view of the page in this place, or a view of its own. */
export function View3dPanel() {
  const path = useBench((s) => s.bench?.view3d);
  const drawn = useWebgl();
  const hosted = usePlaces((s) => s.hosted);
  const served = useServed();
  if (path === undefined) return <EmptyState title="No bench yet">The device appears here in 3D.</EmptyState>;
  if (path === null)
    return (
      <PlanView because={`This ${served ? "server draws" : "page has"} no 3D, so the device is drawn from above`} />
    );
  if (!drawn) return <PlanView because="This browser has no WebGL, so the device is drawn from above" />;
  return hosted ? <Place /> : <OwnView key={path} path={`.${path}`} />;
}

/** Room for the view the page keeps; there is one, and the latest panel has it. */
function Place() {
  const place = useRef<HTMLDivElement>(null);
  const elsewhere = usePlaces((s) => s.shown !== undefined && s.shown !== place.current);
  useEffect(() => (place.current ? offerPlace(place.current) : undefined), []);
  return (
    <div ref={place} className={styles.view}>
      {elsewhere && (
        <EmptyState title="Shown in another panel">
          There is one 3D view; close the other panel to see it here.
        </EmptyState>
      )}
    </div>
  );
}

function OwnView({ path }: { path: string }) {
  const place = useRef<HTMLDivElement>(null);
  const onScreen = useOnScreen(place);
  const visible = usePanelVisible() && onScreen;
  return (
    <div ref={place} className={styles.view}>
      <View3dFrame path={path} visible={visible} />
    </div>
  );
}
