import { useEffect, useState } from "react";
import { useMe } from "../api/me";
import { mayBeRecord, openRecordFile } from "./open-record";
import styles from "./records.module.css";

/** A record may be dropped anywhere on the page; a place of its own for other files has its drops to itself. */
export function RecordDrop() {
  const [over, setOver] = useState(false);
  const role = useMe((s) => s.me?.role);
  const may = role === "teacher" || role === "student";
  useEffect(() => {
    if (!may) return;
    const hasFile = (event: DragEvent) => event.dataTransfer?.types.includes("Files") && !event.defaultPrevented;
    const move = (event: DragEvent) => {
      const isHere = Boolean(hasFile(event));
      setOver(isHere);
      if (isHere) event.preventDefault();
    };
    const leave = (event: DragEvent) => event.relatedTarget === null && setOver(false);
    const drop = (event: DragEvent) => {
      setOver(false);
      const file = event.dataTransfer?.files[0];
      if (event.defaultPrevented || !file) return;
      event.preventDefault();
      if (mayBeRecord(file.name)) openRecordFile(file);
    };
    window.addEventListener("dragover", move);
    window.addEventListener("dragleave", leave);
    window.addEventListener("drop", drop);
    return () => {
      window.removeEventListener("dragover", move);
      window.removeEventListener("dragleave", leave);
      window.removeEventListener("drop", drop);
    };
  }, [may]);
  return over ? <div className={styles.over}>Drop a record of your device: CSV, Parquet, MAT or NetCDF</div> : null;
}
