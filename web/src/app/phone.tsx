import { ActionIcon, Button, NativeSelect, SegmentedControl } from "@mantine/core";
import { IconPlayerPauseFilled, IconPlayerPlayFilled, IconShare2, IconX } from "@tabler/icons-react";
import { useEffect, useRef, useState } from "react";
import { hasAxes } from "../api/fits";
import { useMay } from "../api/me";
import { PanelVisible } from "../api/panel-visible";
import type { Bench } from "../api/types";
import { actions } from "../bench/actions";
import { panelOf, type ViewName } from "../bench/panel-views";
import { useView } from "../bench/view-store";
import { ScopePanel } from "../panels/scope/scope-panel";
import { useBench } from "../stream/bench-store";
import { useBoardState } from "../stream/freshness";
import { type ScopeConfig, scopeConfig } from "../stream/scope-config";
import { ErrorFence } from "../ui/error-fence";
import { usePageVisible } from "../ui/on-screen";
import { CompanyMenu } from "./header/company";
import { DeviceClock } from "./header/device-clock";
import { StateBadge } from "./header/state-badge";
import { Visitor } from "./header/visitor";
import { PanelBody } from "./panel-body";
import { PANELS, panelsOn, VIEW, viewsOn } from "./panels";
import styles from "./phone.module.css";

const MOTION = scopeConfig(["plant.displacement", "model.displacement"]);
/** What is served while a fault is hidden. */
const MEASURED = scopeConfig(["sensor.displacement", "model.displacement"]);
const RATE = scopeConfig(["rate.rate", "@active.rate"], { windowMs: 200 });

/** A bench in the hand: status, one scope, the lanes, 3D, and the button that stops it. */
export function Phone() {
  const state = useBoardState();
  const running = state === "running";
  const title = useBench((s) => s.bench?.title);
  const isFlat = useBench((s) => !hasAxes(s.bench));
  const blind = useBench((s) => s.blind);
  const [chosen, setScope] = useState<ScopeConfig | undefined>(undefined);
  const scope = chosen ?? (!isFlat ? RATE : blind ? MEASURED : MOTION);
  const page = usePageVisible();
  const drives = useMay("drive");
  const teaches = useMay("teach");
  const sheet = useView((s) => s.sheet) && drives;
  return (
    <PanelVisible value={page}>
      <div className={styles.phone}>
        <header className={styles.status}>
          <div>
            <h1>{title ?? "CombBench"}</h1>
            <StateBadge />
          </div>
          <DeviceClock />
          {teaches && (
            <ActionIcon size={34} variant="subtle" aria-label="Share this experiment by a link" onClick={actions.share}>
              <IconShare2 size={19} />
            </ActionIcon>
          )}
        </header>
        <div className={styles.who}>
          <Visitor />
          <CompanyMenu />
        </div>
        <Tabs />
        {sheet ? (
          <main className={styles.sheet}>
            <PanelBody view="sheet" params={{}} setParams={() => undefined} />
          </main>
        ) : (
          <main className={styles.panels}>
            <div className={styles.scope}>
              <ErrorFence name="Scope">
                <ScopePanel config={scope} onChange={setScope} />
              </ErrorFence>
            </div>
            <div className={styles.lanes}>
              <PanelBody view={isFlat ? "lanes" : "locus"} params={{}} setParams={() => undefined} />
            </div>
            {isFlat && <Why />}
            <div className={styles.view}>
              <PanelBody view="view3d" params={{}} setParams={() => undefined} />
            </div>
            <Extra />
            {!isFlat && <Why />}
          </main>
        )}
        {drives && (
          <footer className={styles.stop}>
            <Button
              fullWidth
              size="lg"
              disabled={state === "tripped" || state === undefined}
              color={running ? "alarm" : "accent"}
              leftSection={running ? <IconPlayerPauseFilled size={20} /> : <IconPlayerPlayFilled size={20} />}
              onClick={actions.toggle}
            >
              {running ? "Stop" : "Run"}
            </Button>
          </footer>
        )}
      </div>
    </PanelVisible>
  );
}

/** The bench, and the lab sheet a tab away. */
function Tabs() {
  const sheet = useView((s) => s.sheet);
  const drives = useMay("drive");
  if (!drives) return null;
  return (
    <SegmentedControl
      fullWidth
      size="xs"
      radius={0}
      className={styles.tabs}
      aria-label="What is shown"
      value={sheet ? "sheet" : "bench"}
      data={[
        { value: "bench", label: "Bench" },
        { value: "sheet", label: "Lab sheet" },
      ]}
      onChange={(shown) => useView.setState({ sheet: shown === "sheet" })}
    />
  );
}

/** Why a sample was judged as it was, below the lanes it was chosen in; both are in sight. */
function Why() {
  const chosen = useView((s) => s.sample !== undefined);
  const place = useRef<HTMLElement>(null);
  useEffect(() => {
    if (chosen) place.current?.previousElementSibling?.scrollIntoView({ block: "start" });
  }, [chosen]);
  if (!chosen) return null;
  return (
    <section ref={place} className={styles.why} aria-label="Why">
      <ActionIcon
        className={styles.close}
        variant="subtle"
        color="gray"
        aria-label="Close Why"
        onClick={() => useView.setState({ sample: undefined })}
      >
        <IconX size={16} />
      </ActionIcon>
      <PanelBody view="why" params={{}} setParams={() => undefined} />
    </section>
  );
}

/** One more panel, of any kind; what is clicked elsewhere opens here. */
function Extra() {
  const kind = useView((s) => s.extra);
  const bench = useBench((s) => s.bench);
  const place = useRef<HTMLDivElement>(null);
  const view = panelOf(kind) ? (kind as ViewName) : undefined;
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
          ...panelsOn(bench).map((panel) => ({
            group: PANELS[panel].title,
            items: viewsOn(panel, bench)
              .filter((name) => !always(bench).includes(name))
              .map((value) => ({ value, label: VIEW[value].title })),
          })),
        ]}
        onChange={(e) => useView.setState({ extra: e.currentTarget.value })}
      />
      {view && (
        <div className={styles.panel}>
          <PanelBody key={view} view={view} params={{}} setParams={() => undefined} />
        </div>
      )}
    </div>
  );
}

/** What a phone shows anyway. */
const always = (bench: Bench | undefined) => ["time", "view3d", "why", "sheet", hasAxes(bench) ? "locus" : "lanes"];
