import { create } from "zustand";
import { useView } from "../bench/view-store";

/** The endings of files that may hold a record. */
export const ENDINGS = [".csv", ".txt", ".tsv", ".dat", ".parquet", ".mat", ".npz", ".nc", ".h5", ".hdf5", ".live"];

/** Whether a file may hold a record, by its name. */
export const mayBeRecord = (name: string): boolean => ENDINGS.some((ending) => name.toLowerCase().endsWith(ending));

/** The sheet of records: a file that is to be brought in, or the record that is shown. */
export const useRecords = create<{ file: File | undefined; shown: string | undefined }>(() => ({
  file: undefined,
  shown: undefined,
}));

/** Bring a file in, in the sheet of records. */
export function openRecordFile(file: File): void {
  useRecords.setState({ file, shown: undefined });
  useView.setState({ dialog: "record" });
}
