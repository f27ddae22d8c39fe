import { Box, Button } from "@mantine/core";
import { IconArrowLeft } from "@tabler/icons-react";
import { useMay } from "../../api/me";
import { feeds, useSensor } from "../../bench/sensor";
import { setPage } from "../../bench/view-store";
import { useBench } from "../../stream/bench-store";
import { BenchMenu } from "./bench-menu";
import { CompanyMenu } from "./company";
import { ControllerSelect } from "./controller-select";
import { DeviceClock } from "./device-clock";
import { DeviceSelect } from "./device-select";
import styles from "./header.module.css";
import { HeaderSelect, useLockedWhileHidden } from "./header-select";
import { RunControls } from "./run-controls";
import { StateBadge } from "./state-badge";
import { TimeScaleControl } from "./time-scale-control";
import { Tools } from "./tools";
import { Visitor } from "./visitor";

/** The strip along the top: the bench, its speed, and the most common actions. */
export function Header() {
  const drives = useMay("drive");
  return (
    <header className={styles.header}>
      <img src="./comb.svg" alt="" width="26" height="26" />
      <h1 className={styles.title}>CombBench</h1>
      <BenchMenu />
      <DeviceSelect />
      <SensorSelect />
      <ControllerSelect />
      <div className={`line ${styles.middle}`}>
        {drives && <RunControls />}
        <StateBadge />
        {drives && <TimeScaleControl />}
        <DeviceClock />
      </div>
      <CompanyMenu />
      <Visitor />
      <Tools />
    </header>
  );
}

/** The sensor of a record, which is in no list to choose from. */
const MEASURED = { value: "recorded", title: "As measured", about: "The displacement in the record" };

/** Which sensor feeds the controllers. */
export function SensorSelect() {
  const { kind, sensors, use } = useSensor();
  const locked = useLockedWhileHidden();
  const record = useBench((s) => Boolean(s.bench?.record));
  const choices = record
    ? [MEASURED]
    : sensors.filter(feeds).map(({ name, title, summary }) => ({ value: name, title, about: summary }));
  return (
    <HeaderSelect label="Sensor" value={kind} choices={choices} locked={locked} onChoose={(name) => void use(name)} />
  );
}

/** The strip along the top of the other pages: the bench by its name and state, and the way back to it. */
export function PageHeader() {
  const title = useBench((s) => s.bench?.title);
  return (
    <header className={`${styles.header} ${styles.plain}`}>
      <img src="./comb.svg" alt="" width="22" height="22" />
      <h1 className={styles.title}>CombBench</h1>
      <Button leftSection={<IconArrowLeft size={15} />} onClick={() => setPage("bench")}>
        Back to the bench
      </Button>
      <Box component="strong" className="cut" fw={560}>
        {title ?? "No bench"}
      </Box>
      <StateBadge />
      <Visitor />
    </header>
  );
}
