import { Menu, NativeSelect } from "@mantine/core";
import { IconRuler2, IconWaveSquare } from "@tabler/icons-react";
import type { ReactNode } from "react";
import { useServed } from "../../api/me";
import type { ScopeConfig } from "../../stream/scope-config";
import { TIME_WINDOWS_MS, windowItems } from "../../ui/time-axis";
import { LiveButton } from "./live-button";
import styles from "./scope.module.css";
import { TriggerMenu, type TriggerState } from "./trigger-menu";

interface ScopeToolbarProps {
  config: ScopeConfig;
  onChange(config: ScopeConfig): void;
  past: boolean;
  onLive(): void;
  trigger: TriggerState;
  onRearm(): void;
  /** The menu of the tools, which also saves the picture. */
  exporter: (tools: ReactNode) => ReactNode;
  children: ReactNode;
}

/** The bar of a scope: signals, time window, a menu of tools, live. */
export function ScopeToolbar(props: ScopeToolbarProps) {
  const { config, onChange, past, onLive, trigger, onRearm, exporter, children } = props;
  const served = useServed();
  const isTriggered = config.mode === "triggered";
  const hold = () => onChange({ ...config, mode: isTriggered ? "roll" : "triggered" });
  const measure = () => onChange({ ...config, measure: !config.measure });
  return (
    <div className={`line ${styles.toolbar}`}>
      <div className={`line ${styles.signals}`}>{children}</div>
      <div className={`line ${styles.tools}`}>
        {isTriggered && (
          <TriggerMenu
            trigger={config.trigger}
            state={trigger}
            onChange={(next) => onChange({ ...config, trigger: next })}
            onRearm={onRearm}
          />
        )}
        <NativeSelect
          aria-label="Time window"
          w={86}
          value={String(config.windowMs)}
          data={windowItems(TIME_WINDOWS_MS.scope, config.windowMs)}
          onChange={(event) => onChange({ ...config, windowMs: Number(event.currentTarget.value) })}
        />
        {exporter(
          <>
            {served && (
              <Menu.Item leftSection={<IconWaveSquare size={15} />} onClick={hold}>
                {isTriggered ? "Let the picture roll again" : "Trigger: hold the picture at an edge"}
              </Menu.Item>
            )}
            <Menu.Item leftSection={<IconRuler2 size={15} />} onClick={measure}>
              {config.measure ? "Without cursors and figures" : "Measure: cursors A and B, and figures"}
            </Menu.Item>
          </>,
        )}
        <LiveButton past={past} onLive={onLive} />
      </div>
    </div>
  );
}
