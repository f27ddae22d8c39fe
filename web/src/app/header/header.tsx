import { useMay } from "../../api/me";
import { BenchMenu } from "./bench-menu";
import { CompanyMenu } from "./company";
import { ControllerSelect } from "./controller-select";
import { DeviceClock } from "./device-clock";
import { DeviceSelect } from "./device-select";
import styles from "./header.module.css";
import { RunControls } from "./run-controls";
import { SensorSelect } from "./sensor-select";
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
