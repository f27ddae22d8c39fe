import { Button, NativeSelect } from "@mantine/core";
import { beginWith, lastThatWorked, type UnitVersion, useDraft } from "../../bench/unit-draft";

const STATES: Record<UnitVersion["state"], string> = {
  ran: "ran",
  tripped: "tripped the bench",
  refused: "was refused",
  left: "was left",
};
const NONE: UnitVersion[] = [];

/** When a version was made, by the clock on the wall. */
export const timeOf = ({ at }: UnitVersion): string => new Date(at).toLocaleTimeString([], { hour12: false });

/** The versions of the unit that this browser keeps: choose one to see the difference, or go back. */
export function Versions({ chosen, onChoose }: { chosen: number | undefined; onChoose(at: number | undefined): void }) {
  const { name, source } = useDraft();
  const versions = useDraft((s) => s.versions[name]) ?? NONE;
  const worked = lastThatWorked(versions, source);
  return (
    <>
      <NativeSelect
        w="20ch"
        aria-label="Version"
        value={chosen ?? ""}
        disabled={versions.length === 0}
        data={[
          { value: "", label: versions.length ? `Versions (${versions.length})…` : "No version yet" },
          ...versions.toReversed().map((version) => ({
            value: String(version.at),
            label: `${timeOf(version)}, ${STATES[version.state]}, line ${version.line}`,
          })),
        ]}
        onChange={(e) => onChoose(e.currentTarget.value ? Number(e.currentTarget.value) : undefined)}
      />
      <Button
        size="xs"
        disabled={!worked}
        title="Takes the place of the text; the text stays as a version"
        onClick={() => worked && beginWith(name, worked.source)}
      >
        Back to the last that worked
      </Button>
    </>
  );
}
