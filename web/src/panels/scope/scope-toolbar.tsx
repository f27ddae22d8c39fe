import { ActionIcon, Menu, NativeSelect } from "@mantine/core";
import { useElementSize } from "@mantine/hooks";
import { IconRuler2, IconWaveSquare } from "@tabler/icons-react";
import type { ReactNode } from "react";
import { useServed } from "../../api/me";
import type { ScopeConfig } from "../../stream/scope-config";
import { TIME_WINDOWS_MS, windowItems } from "../../ui/time-axis";
import { LiveButton } from "./live-button";
import styles from "./scope.module.css";
import { TriggerMenu, type TriggerState } from "./trigger-menu";

/** In less than this the tools are in a menu. */
const NARROW_PX = 760;

interface ScopeToolbarProps {
  config: ScopeConfig;
  onChange(config: ScopeConfig): void;
  past: boolean;
  onLive(): void;
  trigger: TriggerState;
  onRearm(): void;
  /** Saves the picture; tools without room in the row are in its menu. */
  exporter: (tools: ReactNode) => ReactNode;
  children: ReactNode;
}

/** The tools of a scope: signals, roll or trigger, window, live. */
export function ScopeToolbar(props: ScopeToolbarProps) {
  const { config, onChange, past, onLive, trigger, onRearm, exporter, children } = props;
  const served = useServed();
  const { ref, width } = useElementSize();
  const isNarrow = width > 0 && width < NARROW_PX;
  const isTriggered = config.mode === "triggered";
  const hold = () => onChange({ ...config, mode: isTriggered ? "roll" : "triggered" });
  const measure = () => onChange({ ...config, measure: !config.measure });
  return (
    <div ref={ref} className={`line ${styles.toolbar}`}>
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
        {!isNarrow && served && (
          <button
            type="button"
            className={styles.toggle}
            aria-label="Trigger"
            aria-pressed={isTriggered}
            title={isTriggered ? "Let the picture roll again" : "Hold the picture at an edge of a signal"}
            onClick={hold}
          >
            <IconWaveSquare size={15} aria-hidden="true" />
            <span>Trigger</span>
          </button>
        )}
        <NativeSelect
          aria-label="Time window"
          w={86}
          value={String(config.windowMs)}
          data={windowItems(TIME_WINDOWS_MS.scope, config.windowMs)}
          onChange={(event) => onChange({ ...config, windowMs: Number(event.currentTarget.value) })}
        />
        {!isNarrow && (
          <ActionIcon
            size={26}
            variant={config.measure ? "light" : "default"}
            aria-label="Measure"
            aria-pressed={config.measure ?? false}
            title="Cursors A and B, and figures over the visible span"
            onClick={measure}
          >
            <IconRuler2 size={15} />
          </ActionIcon>
        )}
        {exporter(
          isNarrow && (
            <>
              {served && (
                <Menu.Item leftSection={<IconWaveSquare size={15} />} onClick={hold}>
                  {isTriggered ? "Let the picture roll again" : "Trigger: hold the picture at an edge"}
                </Menu.Item>
              )}
              <Menu.Item leftSection={<IconRuler2 size={15} />} onClick={measure}>
                {config.measure ? "Without cursors and figures" : "Measure: cursors A and B, and figures"}
              </Menu.Item>
            </>
          ),
        )}
        <LiveButton past={past} onLive={onLive} />
      </div>
    </div>
  );
}
