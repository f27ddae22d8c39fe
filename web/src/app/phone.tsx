import { Button, NativeSelect } from "@mantine/core";
import { IconPlayerPauseFilled, IconPlayerPlayFilled } from "@tabler/icons-react";
import { useEffect, useRef, useState } from "react";
import { scopeConfig } from "../panels/scope/scope-config";
import { ScopePanel } from "../panels/scope/scope-panel";
import { useBench } from "../stream/bench-store";
import { ErrorFence } from "../ui/error-fence";
import { PanelVisible } from "../ui/panel-visible";
import { usePageVisible } from "../ui/use-page-visible";
import { actions } from "./actions";
import { DeviceClock } from "./header/device-clock";
import { StateBadge } from "./header/state-badge";
import { PanelBody } from "./panel-body";
import { PANELS } from "./panels";
import styles from "./phone.module.css";
import { useView } from "./view-store";

/** A bench in the hand: status, one scope, the lanes, 3D, and the button that stops it. */
export function Phone() {
  const running = useBench((s) => s.bench?.state === "running");
  const tripped = useBench((s) => s.bench?.state === "tripped");
  const title = useBench((s) => s.bench?.title);
  const [scope, setScope] = useState(() => scopeConfig(["model.displacement", "plant.displacement"]));
  const page = usePageVisible();
  return (
    <PanelVisible value={page}>
      <div className={styles.phone}>
        <header className={styles.status}>
          <div>
            <h1>{title ?? "CombBench"}</h1>
            <StateBadge />
          </div>
          <DeviceClock />
        </header>
        <main className={styles.panels}>
          <div className={styles.scope}>
            <ErrorFence name="Scope">
              <ScopePanel config={scope} onChange={setScope} />
            </ErrorFence>
          </div>
          <div className={styles.lanes}>
            <PanelBody kind={PANELS.lanes} params={{}} setParams={() => undefined} />
          </div>
          <div className={styles.view}>
            <PanelBody kind={PANELS.view3d} params={{}} setParams={() => undefined} />
          </div>
          <Extra />
        </main>
        <footer className={styles.stop}>
          <Button
            fullWidth
            size="lg"
            disabled={tripped}
            color={running ? "alarm" : "accent"}
            leftSection={running ? <IconPlayerPauseFilled size={20} /> : <IconPlayerPlayFilled size={20} />}
            onClick={actions.toggle}
          >
            {running ? "Stop" : "Run"}
          </Button>
        </footer>
      </div>
    </PanelVisible>
  );
}

/** One more panel, of any kind; what is clicked elsewhere opens here. */
function Extra() {
  const kind = useView((s) => s.extra);
  const place = useRef<HTMLDivElement>(null);
  const panel = PANELS[kind];
  useEffect(() => {
    if (kind) place.current?.scrollIntoView({ block: "start" });
  }, [kind]);
  return (
    <div ref={place} className={styles.extra}>
      <NativeSelect
        size="sm"
        aria-label="Another panel"
        value={kind}
        data={[
          { value: "", label: "Another panel…" },
          ...Object.entries(PANELS)
            .filter(([name]) => !ALWAYS.includes(name))
            .map(([value, { title }]) => ({ value, label: title })),
        ]}
        onChange={(e) => useView.setState({ extra: e.currentTarget.value })}
      />
      {panel && (
        <div className={styles.panel}>
          <PanelBody key={kind} kind={panel} params={{}} setParams={() => undefined} />
        </div>
      )}
    </div>
  );
}

/** What a phone shows anyway. */
const ALWAYS = ["scope", "lanes", "view3d"];
