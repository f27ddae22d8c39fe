import { Box, Button, Group, NumberInput, SegmentedControl, Stack } from "@mantine/core";
import { useServed } from "../../api/me";
import type { BlockCard, Parameter } from "../../api/types";
import { type SeverityScale, severityText } from "../../bench/severity";
import { Formula } from "../../ui/formula";
import { Slider } from "../../ui/slider";
import { unitText } from "../../ui/unit-scale";
import { ParameterRow } from "../card/parameter-row";
import { ConditionFields } from "../condition/condition-fields";
import { draftSeverity, type Entry, type FaultDraft, ownParameters, refusals, scaled } from "./fault-draft";
import styles from "./faults.module.css";

interface FaultFormProps {
  fault: BlockCard;
  parameter: Parameter | undefined;
  scale: SeverityScale;
  suggested: number;
  draft: FaultDraft;
  onChange(draft: FaultDraft): void;
  onInject(): void;
}

/** Severity, profile and moment of a fault. */
export function FaultForm({ fault, parameter, scale, suggested, draft, onChange, onInject }: FaultFormProps) {
  const set = (part: Partial<FaultDraft>) => onChange({ ...draft, ...part });
  const wrong = refusals(draft, scale, parameter?.unit ?? "");
  const number = (key: "severity" | "durationMs" | "periodMs" | "duty" | "atMs", factor = 1) => ({
    value: scaled(draft[key], factor),
    error: wrong[key],
    clampBehavior: "none" as const, // a value beyond the limits is refused in words
    onChange: (value: Entry) => set({ [key]: scaled(value, 1 / factor) }),
  });
  const own = ownParameters(fault);
  const factor = scale.percent ? 100 : 1;
  const served = useServed();
  const grid = parameter?.grid ?? undefined;
  const ends = grid ? [grid[0], grid[grid.length - 1]] : [scale.low, scale.high];
  const unit = scale.percent ? "%" : unitText(parameter?.unit ?? "");
  return (
    <Box p="0 12px 12px 27px">
      <Box component="p" className="note" m="0 0 4px">
        Changes the {fault.changes ?? fault.summary}.
      </Box>
      {fault.equations.map((equation) => (
        <Formula key={equation.latex} latex={equation.latex} />
      ))}
      <Stack gap="sm">
        <Group gap="md" wrap="nowrap" align="center">
          <Slider
            flex={1}
            size="sm"
            min={ends[0] * factor}
            max={ends[1] * factor}
            step={scale.step}
            restrictToMarks={grid !== undefined}
            value={Number(scaled(draft.severity, factor)) || 0}
            label={null}
            thumbLabel={`Severity of ${fault.title}`}
            marks={(grid ?? [scale.low, 0, suggested, scale.high])
              .filter((v, i, all) => all.indexOf(v) === i)
              .map((v) => ({
                value: v * factor,
                label: v === ends[0] || v === ends[1] ? severityText(v, scale, parameter?.unit ?? "") : undefined,
              }))}
            onChange={(value) => set({ severity: scaled(value, 1 / factor) })}
            mb={18}
          />
          <NumberInput
            w={96}
            aria-label={`Severity of ${fault.title}, exact`}
            suffix={` ${unit}`}
            step={scale.step}
            min={scaled(scale.minimum, factor) as number}
            max={scaled(scale.maximum, factor) as number}
            {...number("severity", factor)}
          />
        </Group>
        {own.length > 0 && (
          <div style={{ borderTop: "1px solid var(--line)" }}>
            {own.map((entry) => (
              <ParameterRow
                key={entry.name}
                parameter={{ ...entry, live: true }}
                value={draft.parameters[entry.name] ?? entry.default}
                staged={false}
                onChange={(value) => set({ parameters: { ...draft.parameters, [entry.name]: value } })}
              />
            ))}
          </div>
        )}
        {served && (
          <SegmentedControl
            fullWidth
            aria-label="How it comes"
            value={draft.profile}
            data={["step", "ramp", "intermittent"]}
            onChange={(profile) => set({ profile: profile as FaultDraft["profile"] })}
          />
        )}
        {draft.profile === "ramp" && <NumberInput label="Over" suffix=" ms" min={0.01} {...number("durationMs")} />}
        {draft.profile === "intermittent" && (
          <Group grow gap="sm">
            <NumberInput label="Every" suffix=" ms" min={0.01} {...number("periodMs")} />
            <NumberInput label="On for" suffix=" %" min={1} max={100} {...number("duty", 100)} />
          </Group>
        )}
        <SegmentedControl
          fullWidth
          aria-label="When it comes"
          value={draft.moment}
          data={[
            { value: "now", label: "now" },
            { value: "at", label: "at a time" },
            { value: "when", label: "on a condition" },
          ]}
          onChange={(moment) => set({ moment: moment as FaultDraft["moment"] })}
        />
        {draft.moment === "at" && <NumberInput label="At device time" suffix=" ms" min={0} {...number("atMs")} />}
        {draft.moment === "when" && (
          <div className={styles.when}>
            <ConditionFields
              label="When"
              condition={draft.when}
              error={wrong.when}
              onChange={(when) => set({ when })}
            />
          </div>
        )}
        <Button variant="filled" size="xs" onClick={onInject}>
          {draft.moment === "now" ? "Inject" : "Let it wait for its moment"}{" "}
          {draftSeverity(draft, scale, parameter?.unit ?? "")}
        </Button>
      </Stack>
    </Box>
  );
}
