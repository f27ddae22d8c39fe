import { ActionIcon, Box } from "@mantine/core";
import { IconX } from "@tabler/icons-react";
import { useEffect, useState } from "react";
import { useShallow } from "zustand/react/shallow";
import { hasAxes } from "../api/fits";
import { useMay } from "../api/me";
import { PanelVisible } from "../api/panel-visible";
import { type PanelName, panelOf, type ViewName } from "../bench/panel-views";
import { useView } from "../bench/view-store";
import { ScopePanel } from "../panels/scope/scope-panel";
import { useBench } from "../stream/bench-store";
import { type ScopeConfig, scopeConfig } from "../stream/scope-config";
import { ErrorFence } from "../ui/error-fence";
import { usePageVisible } from "../ui/on-screen";
import { motionOf } from "./built-in-layouts";
import { Caption } from "./caption";
import { CompanyMenu } from "./header/company";
import { DeviceClock } from "./header/device-clock";
import { StateBadge } from "./header/state-badge";
import { Visitor } from "./header/visitor";
import { PanelBody } from "./panel-body";
import { PANELS, type PanelParams, VIEW, viewsOn } from "./panels";
import styles from "./phone.module.css";
import { PhoneBar } from "./phone-bar";
import { PhoneMore } from "./phone-more";
import { Split } from "./split";

const RATE = scopeConfig(["rate.rate", "@active.rate"], { windowMs: 200 });

/** A bench in the hand: one scope, one view below it, and a bar that the thumb reaches. */
export function Phone() {
  const title = useBench((s) => s.bench?.title);
  const isFlat = useBench((s) => !hasAxes(s.bench));
  const usual = useBench((s) => (hasAxes(s.bench) ? RATE : motionOf(Boolean(s.bench?.record))));
  const [chosen, setScope] = useState<ScopeConfig | undefined>(undefined);
  const [more, setMore] = useState(false);
  const page = usePageVisible();
  return (
    <PanelVisible value={page}>
      <div className={`column ${styles.phone}`}>
        <header className={styles.status}>
          <div>
            <h1>{title ?? "CombBench"}</h1>
            <Visitor />
          </div>
          <div>
            <StateBadge />
            <CompanyMenu />
            <DeviceClock />
          </div>
        </header>
        <Split
          upper={
            <ErrorFence name="Scope">
              <ScopePanel config={chosen ?? usual} onChange={setScope} />
            </ErrorFence>
          }
          lower={<Lower usual={isFlat ? "lanes" : "locus"} />}
        />
        <div className={styles.caption}>
          <Caption />
        </div>
        <PhoneBar onMore={() => setMore(true)} />
        <PhoneMore opened={more} onClose={() => setMore(false)} />
      </div>
    </PanelVisible>
  );
}

/** The view below the scope: the lanes, the motion of a gyroscope, or a view that was asked for. */
function Lower({ usual }: { usual: ViewName }) {
  const extra = useView((s) => s.extra);
  const sample = useView((s) => s.sample);
  const drives = useMay("drive");
  useEffect(() => {
    if (sample) useView.setState({ extra: "" });
  }, [sample]);
  const panel = extra === "time" || (extra === "sheet" && !drives) ? undefined : panelOf(extra);
  if (panel) return <Asked key={panel} panel={panel} view={extra as ViewName} />;
  return (
    <div style={{ overflowY: "auto" }}>
      <Box h="100%" mih={220}>
        <PanelBody view={usual} params={{}} setParams={() => undefined} />
      </Box>
      {sample && <Why />}
    </div>
  );
}

/** A view that was asked for, with the other views of its panel and a way back. */
function Asked({ panel, view }: { panel: PanelName; view: ViewName }) {
  const axes = useBench(useShallow((s) => s.bench?.axes));
  const [params, setParams] = useState<PanelParams>({});
  const views = viewsOn(panel, axes && { axes }).filter((name) => name !== "time");
  return (
    <Box component="section" className="column" mih={0} bg="var(--panel)" aria-label={PANELS[panel].title}>
      <div className={styles.views}>
        {views.map((name) => (
          <button
            key={name}
            type="button"
            aria-pressed={name === view}
            onClick={() => useView.setState({ extra: name })}
          >
            {VIEW[name].title}
          </button>
        ))}
        <Close what={PANELS[panel].title} onClose={() => useView.setState({ extra: "" })} />
      </div>
      <div className={styles.body}>
        <PanelBody key={view} view={view} params={params} setParams={setParams} />
      </div>
    </Box>
  );
}

/** Why a sample was judged as it was, below the lanes it was chosen in. */
function Why() {
  return (
    <div ref={(place) => place?.scrollIntoView({ block: "start" })} className={styles.why}>
      <Close what="Why" onClose={() => useView.setState({ sample: undefined })} />
      <PanelBody view="why" params={{}} setParams={() => undefined} />
    </div>
  );
}

function Close({ what, onClose }: { what: string; onClose(): void }) {
  return (
    <ActionIcon className={styles.close} color="gray" aria-label={`Close ${what}`} onClick={onClose}>
      <IconX size={18} />
    </ActionIcon>
  );
}
