import { SideSheet } from "../app/side-sheet";
import { BringRecord } from "./bring-record";
import { useRecords } from "./open-record";
import { RecordView } from "./record-view";

/** A record of a real device: brought in, calibrated, diagnosed, opened on a bench. */
export function RecordSheet() {
  const shown = useRecords((s) => s.shown);
  return (
    <SideSheet name="record" title="A record of your device" size={680}>
      {shown ? <RecordView key={shown} id={shown} /> : <BringRecord />}
    </SideSheet>
  );
}
