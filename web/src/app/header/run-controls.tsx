import { Button, Menu } from "@mantine/core";
import { IconChevronDown, IconPlayerPauseFilled, IconPlayerPlayFilled } from "@tabler/icons-react";
import { actions } from "../../bench/actions";
import { useBench } from "../../stream/bench-store";
import { useBoardState } from "../../stream/freshness";

const STEP_WORDS = "One tick, one drive period, or back to the start";

/** Run, pause, step a tick, step a period, reset. */
export function RunControls() {
  const state = useBoardState();
  const unknown = state === undefined;
  const running = state === "running";
  const stuck = state === "tripped" || unknown;
  const period = useBench((s) => s.bench?.drive_period_ticks ?? null);
  return (
    <div className="line">
      <Button
        variant="filled"
        size="compact-md"
        w="6.5em"
        leftSection={running ? <IconPlayerPauseFilled size={17} /> : <IconPlayerPlayFilled size={17} />}
        title={running ? "Pause (space)" : "Run (space)"}
        disabled={stuck}
        onClick={actions.toggle}
      >
        {running ? "Pause" : "Run"}
      </Button>
      <Menu position="bottom-start">
        <Menu.Target>
          <Button
            size="compact-md"
            variant="subtle"
            px={6}
            rightSection={<IconChevronDown size={13} />}
            title={STEP_WORDS}
            disabled={unknown}
          >
            Step
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          <Menu.Item disabled={stuck} onClick={actions.stepTick}>
            One tick ( . )
          </Menu.Item>
          <Menu.Item disabled={stuck || period === null} onClick={actions.stepPeriod}>
            One drive period ( , ){period === null && <small>The drive has no period of its own</small>}
          </Menu.Item>
          <Menu.Divider />
          <Menu.Item onClick={actions.reset}>Reset to the start (Shift R)</Menu.Item>
        </Menu.Dropdown>
      </Menu>
    </div>
  );
}
