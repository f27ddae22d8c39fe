import {
  IconAdjustmentsHorizontal,
  IconAlertTriangle,
  IconDots,
  IconFileText,
  IconPlayerPauseFilled,
  IconPlayerPlayFilled,
} from "@tabler/icons-react";
import type { ReactNode } from "react";
import { useMay, useServed } from "../api/me";
import { actions } from "../bench/actions";
import type { ViewName } from "../bench/panel-views";
import { useView } from "../bench/view-store";
import { useBench } from "../stream/bench-store";
import { useBoardState } from "../stream/freshness";
import styles from "./phone.module.css";

/** The bar within reach of a thumb: run and stop, the views that change the bench, and all others. */
export function PhoneBar({ onMore }: { onMore(): void }) {
  const state = useBoardState();
  const running = state === "running";
  const hides = useBench((s) => s.blind && !s.bench?.blind?.game);
  const drives = useMay("drive");
  const served = useServed();
  return (
    // biome-ignore lint/a11y/useSemanticElements: a fieldset draws a frame
    <div className={styles.bar} role="group" aria-label="Bench">
      {drives && (
        <>
          <button
            type="button"
            className="bar-button"
            data-run={running ? "stop" : "run"}
            disabled={state === "tripped" || state === undefined}
            onClick={actions.toggle}
          >
            {running ? <IconPlayerPauseFilled size={20} /> : <IconPlayerPlayFilled size={20} />}
            {running ? "Stop" : "Run"}
          </button>
          <Turn view="controllers" words="Controller" icon={<IconAdjustmentsHorizontal size={20} />} />
          {hides ? (
            <Turn view="blind" words="Answer" icon={<IconAlertTriangle size={20} />} />
          ) : (
            <Turn view="faults" words="Faults" icon={<IconAlertTriangle size={20} />} />
          )}
          {served && <Turn view="sheet" words="Lab sheet" icon={<IconFileText size={20} />} />}
        </>
      )}
      <button type="button" className="bar-button" aria-haspopup="dialog" onClick={onMore}>
        <IconDots size={20} />
        More
      </button>
    </div>
  );
}

/** Show a view below the scope, or the usual one again. */
function Turn({ view, words, icon }: { view: ViewName; words: string; icon: ReactNode }) {
  const shown = useView((s) => s.extra === view);
  return (
    <button
      type="button"
      className="bar-button"
      aria-pressed={shown}
      onClick={() => useView.setState({ extra: shown ? "" : view })}
    >
      {icon}
      {words}
    </button>
  );
}
