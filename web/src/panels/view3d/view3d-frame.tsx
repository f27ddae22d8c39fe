import { useEffect, useRef, useState } from "react";
import { ticketed } from "../../api/launch";
import { isInFrame, sessionHeaders } from "../../api/session";
import { useView } from "../../bench/view-store";
import { staleWords, useStaleSince } from "../../stream/freshness";
import { hover } from "../../ui/hover";
import { usePageVisible } from "../../ui/on-screen";
import { useScheme } from "../../ui/use-canvas";
import styles from "./view3d.module.css";
import { softwareGl, useSceneFailed } from "./webgl";

const POLL_MS = 1000;
/** The traces come first: loading the 3D page holds the main thread for a while. */
const HEAD_START_MS = 1200;
/** Between two moments that the device is shown at under a moving pointer. */
const HOVER_MS = 50;
/** Out of sight for this long, it drops its scene, which costs the server; the camera is kept. */
const IDLE_MS = 120_000;

/** A camera that a user has moved. */
interface Look {
  position: number[];
  target: number[];
}

/**
 * The server's 3D page in a frame, loaded when it is first seen; out of sight it draws nothing.
 *
 * When its connection closes, the frame waits for the server and is loaded afresh, unless the bench is gone. It receives
 * scheme, letters and camera as messages, so that none of them loads it again, and it reports a moved camera, so that loading
 * does not lose it.
 */
export function View3dFrame({ path, visible: inSight }: { path: string; visible: boolean }) {
  const stale = useStaleSince();
  const scheme = useScheme();
  const fontPx = useView((s) => s.fontPx);
  const frame = useRef<HTMLIFrameElement>(null);
  const visible = usePageVisible() && inSight;
  const [ready, setReady] = useState(false);
  const [idle, setIdle] = useState(true);
  const look = useRef<Look | undefined>(undefined);
  const [loads, setLoads] = useState(0);
  const [closed, setClosed] = useState(false);
  const [connected, setConnected] = useState(0);
  const [camera, setCamera] = useState<Camera>("whole");
  const shown = ready && !idle;
  const address = useAddress(path, scheme, shown, loads);

  useEffect(() => {
    const timer = setTimeout(() => setReady(true), HEAD_START_MS);
    return () => clearTimeout(timer);
  }, []);

  useEffect(() => {
    if (visible) return setIdle(false);
    // a frame without a scene has nothing to keep
    const timer = setTimeout(() => setIdle(true), connected === 0 ? 0 : IDLE_MS);
    return () => clearTimeout(timer);
  }, [visible, connected]);

  useEffect(() => {
    const listen = (event: MessageEvent) => {
      if (event.source !== frame.current?.contentWindow || event.origin !== window.location.origin) return;
      const { viser: state, look: moved } = (event.data ?? {}) as { viser?: string; look?: Look };
      if (moved) look.current = moved;
      if (state === "failed") useSceneFailed.setState({ failed: true });
      if (state === "closed") setClosed(true);
      if (state === "connected") {
        setClosed(false);
        setConnected((n) => n + 1);
      }
    };
    window.addEventListener("message", listen);
    return () => window.removeEventListener("message", listen);
  }, []);

  useEffect(() => {
    if (!closed || !visible || stale) return;
    const timer = setInterval(async () => {
      const answer = await fetch(path, { headers: sessionHeaders() }).catch(() => undefined);
      if (!answer?.ok) return;
      setClosed(false);
      setLoads((n) => n + 1);
    }, POLL_MS);
    return () => clearInterval(timer);
  }, [closed, path, visible, stale]);

  const tell = (message: { scheme?: string; fontPx?: number; camera?: Camera; look?: Look; tick?: number | null }) =>
    frame.current?.contentWindow?.postMessage(message, window.location.origin);
  useHovered(connected > 0 && visible, (tick) => tell({ tick }));

  // biome-ignore lint/correctness/useExhaustiveDependencies: a page needs them when it connects
  useEffect(() => tell({ scheme, fontPx }), [scheme, fontPx, connected]);
  // biome-ignore lint/correctness/useExhaustiveDependencies: the same
  useEffect(() => tell(look.current ? { look: look.current } : { camera }), [connected]);

  const choose = (next: Camera) => {
    setCamera(next);
    look.current = undefined;
    tell({ camera: next }); // the same camera again brings the picture back
  };

  return (
    <div className={styles.view}>
      {shown && address && (
        <iframe
          key={`${path}-${loads}`}
          ref={frame}
          className={styles.frame}
          src={address}
          title="The device in 3D"
          hidden={!inSight}
        />
      )}
      <fieldset className={styles.cameras} aria-label="Camera">
        {CAMERAS.map(({ name, label, title }) => (
          <button key={name} type="button" title={title} aria-pressed={name === camera} onClick={() => choose(name)}>
            {label}
          </button>
        ))}
      </fieldset>
      {closed || stale ? (
        <div className={styles.veil} role="status">
          {stale ? `The 3D view is ${staleWords(stale)}` : "The 3D view waits for the server"}
        </div>
      ) : (
        connected === 0 && (
          <div className={styles.loading} role="status">
            The 3D view is loading
          </div>
        )
      )}
    </div>
  );
}

/** Tell the tick under the pointer, at most every HOVER_MS, and null at once when the pointer leaves. */
function useHovered(wanted: boolean, tell: (tick: number | null) => void): void {
  const say = useRef(tell);
  say.current = tell;
  useEffect(() => {
    if (!wanted) return;
    let timer: ReturnType<typeof setTimeout> | undefined;
    let told: number | null = null;
    const now = () => {
      timer = undefined;
      const tick = hover.tick === undefined ? null : Math.floor(hover.tick);
      if (tick === told) return;
      told = tick;
      say.current(tick);
      timer = setTimeout(now, HOVER_MS);
    };
    const stop = hover.listen((tick) => {
      if (tick === undefined) clearTimeout(timer);
      if (tick === undefined || timer === undefined) now();
    });
    return () => {
      stop();
      clearTimeout(timer);
      if (told !== null) say.current(null);
    };
  }, [wanted]);
}

/** Where the frame is loaded from; in a page that has no cookie, by tickets that are made for each time it loads. */
function useAddress(path: string, scheme: string, shown: boolean, loads: number): string | undefined {
  const [plain] = useState(() => `${path}?${query(scheme)}`);
  const [withTickets, setWithTickets] = useState<string | undefined>(undefined);
  // biome-ignore lint/correctness/useExhaustiveDependencies: a frame needs new tickets at each load
  useEffect(() => {
    if (!isInFrame()) return;
    setWithTickets(undefined);
    let wanted = shown;
    if (shown)
      Promise.all([ticketed(plain), ticketed(path.replace(/\/$/, ""))]).then(([page, socket]) => {
        const server = encodeURIComponent(socket.replace(/^http/, "ws"));
        if (wanted) setWithTickets(`${page}&websocket=${server}`);
      });
    return () => {
      wanted = false;
    };
  }, [plain, shown, loads]);
  return isInFrame() ? withTickets : plain;
}

function query(scheme: string): URLSearchParams {
  const ratio = softwareGl() ? 0.5 : Math.min(window.devicePixelRatio, 1.5);
  const wanted = new URLSearchParams({ hideViserLogo: "1", fixedDpr: String(ratio) });
  if (scheme === "dark") wanted.set("darkMode", "1");
  return wanted;
}

/** Where to look at the device from; the 3D page knows each by its name. */
const CAMERAS = [
  { name: "whole", label: "Whole", title: "The whole device" },
  { name: "top", label: "Top", title: "From above, as drawn" },
  { name: "side", label: "Side", title: "Along the wafer" },
  { name: "fingers", label: "Fingers", title: "The fingers of a comb" },
  { name: "beams", label: "Beams", title: "The folded beams of one side" },
] as const;

export type Camera = (typeof CAMERAS)[number]["name"];
