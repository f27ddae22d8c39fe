import { Button, Checkbox, FileButton, Input } from "@mantine/core";
import { IconFileUpload } from "@tabler/icons-react";
import { type DragEvent, useState } from "react";
import { api } from "../api/api";
import { ApiError } from "../api/client";
import { useMay } from "../api/me";
import { noteOwnLink, openOwn } from "../bench/open-bench";
import { setPage, useView } from "../bench/view-store";
import { formatSi } from "../ui/format";
import styles from "./dialogs.module.css";

/** The server takes no larger body. */
const MOST_BYTES = 1_000_000;

/** Open a scenario from disk, chosen or dropped; its errors appear here. Only a teacher can keep it. */
export function OpenScenario({ onKept }: { onKept?(): void }) {
  const teaches = useMay("teach");
  const [keep, setKeep] = useState(true);
  const [busy, setBusy] = useState(false);
  const [over, setOver] = useState(false);
  const [error, setError] = useState("");

  const open = async (file: File | null | undefined) => {
    if (!file) return;
    setBusy(true);
    setError("");
    try {
      if (file.size > MOST_BYTES)
        throw new Error(`is ${formatSi(file.size, "B", 3)} long, at most ${formatSi(MOST_BYTES, "B", 3)}`);
      const scenario = `${await file.text()}\n`; // so that one line is no name of the library
      const bench = await api.createBench({ scenario, paused: false });
      if (keep && teaches) {
        noteOwnLink((await api.makeLink({ scenario, title: "", note: "" })).id);
        onKept?.();
      }
      openOwn(bench.id);
      setPage("bench");
      useView.setState({ dialog: "none" });
    } catch (refused) {
      setError(`${file.name} cannot be opened: ${reason(refused)}`);
    } finally {
      setBusy(false);
    }
  };
  const drag = (isOver: boolean) => (event: DragEvent) => {
    event.preventDefault();
    setOver(isOver);
  };

  return (
    <Input.Wrapper error={error && <span role="alert">{error}</span>} errorProps={{ fz: "sm", mt: 4 }}>
      {/* biome-ignore lint/a11y/noStaticElementInteractions: dropping is beside the button, not instead of it */}
      <div
        className={`row ${styles.drop}`}
        data-over={over}
        data-testid="drop"
        onDragOver={drag(true)}
        onDragLeave={drag(false)}
        onDrop={(event) => {
          drag(false)(event);
          void open(event.dataTransfer.files[0]);
        }}
      >
        <FileButton accept=".toml,application/toml" onChange={open} inputProps={{ "aria-label": "Scenario file" }}>
          {(props) => (
            <Button {...props} variant="light" loading={busy} leftSection={<IconFileUpload size={16} />}>
              Open scenario…
            </Button>
          )}
        </FileButton>
        <span>a TOML file from disk, or drop one here</span>
        {teaches ? (
          <Checkbox label="Keep it here" checked={keep} onChange={(e) => setKeep(e.currentTarget.checked)} />
        ) : (
          <span>It takes the place of your bench.</span>
        )}
      </div>
    </Input.Wrapper>
  );
}

function reason(error: unknown): string {
  if (!(error instanceof ApiError)) return error instanceof Error ? error.message : String(error);
  const { field, message, hint } = error.body;
  return [field && !message.includes(field) ? `${field}: ${message}` : message, hint].filter(Boolean).join(". ");
}
