import { ActionIcon, Box, Button, Group } from "@mantine/core";
import { IconTrash } from "@tabler/icons-react";
import { useCallback, useEffect, useState } from "react";
import { api } from "../api/api";
import type { KeptRecord } from "../api/types";
import styles from "../app/dialogs.module.css";
import { formatSi } from "../ui/format";
import { roundTo } from "../ui/unit-scale";
import { useRecords } from "./open-record";

/** The records that are here, the newest first. */
export function RecordList({ onError }: { onError(error: unknown): void }) {
  const [records, setRecords] = useState<KeptRecord[]>([]);
  const load = useCallback(() => void api.deviceRecords().then(setRecords, onError), [onError]);
  useEffect(load, [load]);
  if (records.length === 0) return null;
  return (
    <>
      <h3 className={styles.heading}>Records that are here</h3>
      <ul className={styles.gallery} aria-label="Records that are here">
        {records.map((record) => (
          <li key={record.id}>
            <Box flex={1} miw={0}>
              <h3>{record.name}</h3>
              <small>{brief(record)}</small>
            </Box>
            <Group flex="none" gap={4} wrap="nowrap">
              <Button
                size="xs"
                variant="light"
                aria-label={`Open ${record.name}`}
                onClick={() => useRecords.setState({ shown: record.id })}
              >
                Open
              </Button>
              <ActionIcon
                aria-label={`Delete ${record.name}`}
                onClick={() =>
                  window.confirm(`Delete ${record.name} for good?`) &&
                  api.removeDeviceRecord(record.id).then(load, onError)
                }
              >
                <IconTrash size={16} />
              </ActionIcon>
            </Group>
          </li>
        ))}
      </ul>
    </>
  );
}

/** The length of a record, and whether it has labels. */
export const brief = ({ samples, rate_khz, labels }: KeptRecord): string =>
  [
    formatSi(samples / rate_khz, "ms"),
    `${samples} samples at ${roundTo(rate_khz, 6)} kHz`,
    labels.length > 0 ? `labels ${labels.join(", ")}` : "no labels",
  ].join(" · ");
