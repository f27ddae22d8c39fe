import { Button, FileButton, NativeSelect } from "@mantine/core";
import { IconFileUpload } from "@tabler/icons-react";
import { useCallback, useEffect, useState } from "react";
import { api } from "../api/api";
import { ApiError } from "../api/client";
import type { FileColumns, RecordReading } from "../api/types";
import { showError } from "../bench/send";
import { MappingForm } from "./mapping-form";
import { ENDINGS, openRecordFile, useRecords } from "./open-record";
import { RecordList } from "./record-list";
import styles from "./records.module.css";

/** Of a text so much shows its columns. */
const HEAD_BYTES = 65_536;
const PAIRINGS = [
  { value: "next", label: "acts from its sample on" },
  { value: "last", label: "acted until its sample" },
] as const;

/** Bring a record in: a file, and its columns and its rate where they are not found; then the records of the server. */
export function BringRecord() {
  const file = useRecords((s) => s.file);
  const [busy, setBusy] = useState(false);
  const [error, setError] = useState("");
  const [columns, setColumns] = useState<FileColumns | undefined>(undefined);
  const [pairing, setPairing] = useState<"next" | "last">("next");

  const bring = useCallback(async (of: File, reading: RecordReading) => {
    setBusy(true);
    setError("");
    try {
      const { id } = await api.bringRecord(of, reading);
      useRecords.setState({ shown: id, file: undefined });
    } catch (refused) {
      setError(reason(refused));
      if (refused instanceof ApiError && refused.status === 422)
        await api.recordColumns(headOf(of, await wholeLines(of))).then(setColumns, () => setColumns(undefined));
    } finally {
      setBusy(false);
    }
  }, []);
  // biome-ignore lint/correctness/useExhaustiveDependencies: a file is brought in once, as it comes
  useEffect(() => {
    setColumns(undefined);
    if (file) void bring(file, { pairing });
  }, [file]);

  return (
    <>
      <p className="note">
        Drive voltage and displacement of a real device, one row for each sample, play in place of the simulated plant.
      </p>
      <div className={`row ${styles.bring}`}>
        <FileButton
          accept={ENDINGS.join()}
          onChange={(chosen) => chosen && openRecordFile(chosen)}
          inputProps={{ "aria-label": "File of the record" }}
        >
          {(props) => (
            <Button {...props} variant="light" loading={busy} leftSection={<IconFileUpload size={16} />}>
              Choose a file…
            </Button>
          )}
        </FileButton>
        <span>CSV, Parquet, MAT or NetCDF; or drop it on the page</span>
        <NativeSelect
          label="The voltage of a row"
          value={pairing}
          data={PAIRINGS}
          onChange={(e) => setPairing(e.currentTarget.value as "next" | "last")}
        />
      </div>
      {busy && file && <p role="status">Reading {file.name}…</p>}
      {file && error && (
        <p role="alert" className="wrong">
          {file.name}: {error}
        </p>
      )}
      {file && columns && (
        <MappingForm columns={columns} busy={busy} onRead={(more) => bring(file, { ...more, pairing })} />
      )}
      <RecordList onError={showError} />
    </>
  );
}

/** The beginning of a text up to the end of a line; any other file is read whole. */
async function wholeLines(file: File): Promise<number> {
  if (!/\.(csv|txt|tsv|dat)$/i.test(file.name) || file.size <= HEAD_BYTES) return file.size;
  const bytes = new Uint8Array(await file.slice(0, HEAD_BYTES).arrayBuffer());
  return bytes.lastIndexOf(10) + 1 || HEAD_BYTES;
}

const headOf = (file: File, end: number) => new File([file.slice(0, end)], file.name);

function reason(error: unknown): string {
  if (!(error instanceof ApiError)) return error instanceof Error ? error.message : String(error);
  const { message, hint } = error.body;
  return [message, hint].filter(Boolean).join(". ");
}
