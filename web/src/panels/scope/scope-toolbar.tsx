import { ActionIcon, NativeSelect } from "@mantine/core";
import { IconRuler2, IconWaveSquare } from "@tabler/icons-react";
import type { ReactNode } from "react";
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
  exporter: ReactNode;
  children: ReactNode;
}

/** The tools of a scope: signals, roll or trigger, window, live. */
export function ScopeToolbar(props: ScopeToolbarProps) {
  const { config, onChange, past, onLive, trigger, onRearm, exporter, children } = props;
  return (
    <div className={`line ${styles.toolbar}`}>
      <div className={`line ${styles.signals}`}>{children}</div>
      <div className={`line ${styles.tools}`}>
        {config.mode === "triggered" && (
          <TriggerMenu
            trigger={config.trigger}
            state={trigger}
            onChange={(next) => onChange({ ...config, trigger: next })}
            onRearm={onRearm}
          />
        )}
        <button
          type="button"
          className={styles.toggle}
          aria-label="Trigger"
          aria-pressed={config.mode === "triggered"}
          title={config.mode === "triggered" ? "Let the picture roll again" : "Hold the picture at an edge of a signal"}
          onClick={() => onChange({ ...config, mode: config.mode === "triggered" ? "roll" : "triggered" })}
        >
          <IconWaveSquare size={15} aria-hidden="true" />
          <span>Trigger</span>
        </button>
        <NativeSelect
          aria-label="Time window"
          w={86}
          value={String(config.windowMs)}
          data={windowItems(TIME_WINDOWS_MS.scope, config.windowMs)}
          onChange={(event) => onChange({ ...config, windowMs: Number(event.currentTarget.value) })}
        />
        <ActionIcon
          size={26}
          variant={config.measure ? "light" : "default"}
          aria-label="Measure"
          aria-pressed={config.measure ?? false}
          title="Cursors A and B, and figures over the visible span"
          onClick={() => onChange({ ...config, measure: !config.measure })}
        >
          <IconRuler2 size={15} />
        </ActionIcon>
        {exporter}
        <LiveButton past={past} onLive={onLive} />
      </div>
    </div>
  );
}
