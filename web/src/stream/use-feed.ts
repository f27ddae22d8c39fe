import { useEffect, useRef } from "react";
import { usePanelVisible } from "../api/panel-visible";
import type { Feed } from "./feed";
import type { PanelFrame } from "./panel-frame";
import { stream } from "./stream";
import type { CaptureList, Subscription } from "./wire";

/**
 * Stream to `draw` while the panel is visible; `draw` runs in the animation loop and must not set React state
 * per frame. With `everyMs` it runs no more often than that, and always on the newest picture in the end.
 * `hear` receives the captures of the trigger when they have changed.
 */
export function useFeed(
  subscription: Subscription | undefined,
  draw: (frame: PanelFrame) => void,
  everyMs = 0,
  hear?: (captures: CaptureList) => void,
) {
  const visible = usePanelVisible();
  const feed = useRef<Feed | undefined>(undefined);
  const painter = useRef(draw);
  painter.current = draw;
  const hearer = useRef(hear);
  hearer.current = hear;
  const wanted = subscription && visible ? JSON.stringify(subscription) : undefined;

  useEffect(() => {
    const { feeds } = stream.client;
    if (wanted === undefined) {
      if (feed.current) feeds.close(feed.current);
      feed.current = undefined;
    } else if (feed.current) {
      feeds.change(feed.current, JSON.parse(wanted) as Subscription);
    } else {
      feed.current = feeds.open(
        JSON.parse(wanted) as Subscription,
        (frame) => painter.current(frame),
        everyMs,
        (list) => hearer.current?.(list),
      );
    }
  }, [wanted, everyMs]);

  useEffect(
    () => () => {
      if (feed.current) stream.client.feeds.close(feed.current);
      feed.current = undefined;
    },
    [],
  );
  return feed;
}
