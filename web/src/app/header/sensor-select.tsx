import { feeds, useSensor } from "../../bench/sensor";
import { HeaderSelect, useLockedWhileHidden } from "./header-select";

/** Which sensor feeds the controllers. */
export function SensorSelect() {
  const { kind, sensors, use } = useSensor();
  const locked = useLockedWhileHidden();
  const choices = sensors.filter(feeds).map(({ name, title, summary }) => ({ value: name, title, about: summary }));
  return (
    <HeaderSelect label="Sensor" value={kind} choices={choices} locked={locked} onChoose={(name) => void use(name)} />
  );
}
