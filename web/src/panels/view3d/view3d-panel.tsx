import { useEffect, useRef, useState } from "react";
import { useScheme } from "../../app/use-scheme";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { usePanelVisible } from "../../ui/panel-visible";
import styles from "./view3d.module.css";

const POLL_MS = 1000;

/** The shuttle in 3D. When its connection closes, the page waits for the server and loads it afresh. */
export function View3dPanel() {
  const path = useBench((s) => s.bench?.view3d);
  const phase = useBench((s) => s.connection.phase);
  const scheme = useScheme();
  const visible = usePanelVisible();
  const frame = useRef<HTMLIFrameElement>(null);
  const [loads, setLoads] = useState(0);
  const [closed, setClosed] = useState(false);

  useEffect(() => {
    const listen = (event: MessageEvent) => {
      if (event.source !== frame.current?.contentWindow || event.origin !== window.location.origin) return;
      const state = (event.data as { viser?: string } | null)?.viser;
      if (state === "closed") setClosed(true);
      if (state === "connected") setClosed(false);
    };
    window.addEventListener("message", listen);
    return () => window.removeEventListener("message", listen);
  }, []);

  useEffect(() => {
    if (!closed || !path || !visible) return;
    const timer = setInterval(async () => {
      const answer = await fetch(path).catch(() => undefined);
      if (!answer?.ok) return;
      setClosed(false);
      setLoads((n) => n + 1);
    }, POLL_MS);
    return () => clearInterval(timer);
  }, [closed, path, visible]);

  if (path === undefined) return <EmptyState title="No bench yet">The device appears here in 3D.</EmptyState>;
  if (path === null)
    return <EmptyState title="No 3D view">This server runs without it; everything else works.</EmptyState>;
  if (!visible) return null;
  const query = new URLSearchParams({ hideViserLogo: "1", fixedDpr: String(Math.min(window.devicePixelRatio, 1.5)) });
  if (scheme === "dark") query.set("darkMode", "1");
  return (
    <div className={styles.view}>
      <iframe
        key={`${path}-${loads}-${scheme}`}
        ref={frame}
        className={styles.frame}
        src={`${path}?${query}`}
        title="The device in 3D"
      />
      {(closed || phase === "waiting") && (
        <div className={styles.veil} role="status">
          The 3D view waits for the server
        </div>
      )}
    </div>
  );
}
