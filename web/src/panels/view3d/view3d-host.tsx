import { useEffect, useRef } from "react";
import { create } from "zustand";
import { useBench } from "../../stream/bench-store";
import { stream } from "../../stream/stream";
import { useChanged } from "../../ui/use-changed";
import styles from "./view3d.module.css";
import { View3dFrame } from "./view3d-frame";
import { useWebgl } from "./webgl";

/**
 * The 3D view, kept outside the dock and laid over the panel that is in sight.
 *
 * A frame that moves within the document loads again: here panels may come, go and move, and scene and camera stay.
 */
export function View3dHost() {
  // the scene tells which fault acts, so nothing is kept of it while the fault is to be found
  const path = useBench((s) => (s.blind ? undefined : s.bench?.view3d));
  const drawn = useWebgl();
  const host = useRef<HTMLElement>(null);
  const [visible, setVisible] = useChanged(false);
  useEffect(() => {
    usePlaces.setState({ hosted: true });
    let laid: HTMLElement | undefined;
    let place = "";
    const stop = stream.loop.add(() => {
      const { places, shown } = usePlaces.getState();
      const rects = places.map((place) => place.getBoundingClientRect());
      const at = rects.findLastIndex(({ width, height }) => width > 0 && height > 0);
      const rect = rects[at];
      if (places[at] !== shown) usePlaces.setState({ shown: places[at] });
      setVisible(rect !== undefined);
      if (!rect || !host.current) return;
      const wanted = `${rect.left}px ${rect.top}px ${rect.width}px ${rect.height}px`;
      if (laid === host.current && place === wanted) return; // the host of another bench has no place yet
      laid = host.current;
      place = wanted;
      const [left, top, width, height] = wanted.split(" ");
      Object.assign(host.current.style, { left, top, width, height });
    });
    return () => {
      stop();
      usePlaces.setState({ hosted: false, shown: undefined });
    };
  }, [setVisible]);
  if (!path || !drawn) return null;
  return (
    <section ref={host} className={styles.host} aria-label="3D view" hidden={!visible}>
      <View3dFrame key={path} path={`.${path}`} visible={visible} />
    </section>
  );
}

interface Places {
  /** Whether the page keeps the 3D view itself and lays it over a panel; a phone draws it in the panel. */
  hosted: boolean;
  /** Panels that offer their place, the latest last. */
  places: HTMLElement[];
  /** The place that has the 3D view. */
  shown: HTMLElement | undefined;
}

/** Where the 3D view may be shown. */
export const usePlaces = create<Places>(() => ({ hosted: false, places: [], shown: undefined }));

/** Offer the place of a panel; the returned function withdraws it. */
export function offerPlace(place: HTMLElement): () => void {
  usePlaces.setState(({ places }) => ({ places: [...places, place] }));
  return () => usePlaces.setState(({ places }) => ({ places: places.filter((other) => other !== place) }));
}
