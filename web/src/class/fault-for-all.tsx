import { Button, NativeSelect, NumberInput } from "@mantine/core";
import { useState } from "react";
import type { Command } from "../api/types";
import { useCatalog } from "../api/use-catalog";
import { severityScale, severityText } from "../bench/severity";
import { roundTo, unitText } from "../ui/unit-scale";
import { CHOICE, GroupForAll } from "./group-for-all";

const USUAL = 0.05;

interface FaultForAllProps {
  count: number;
  /** The command under way. */
  busy: string | undefined;
  command(what: string, order: Command): void;
}

/** A fault with its severity for all students or for those chosen, and the end of all faults. */
export function FaultForAll({ count, busy, command }: FaultForAllProps) {
  const { blocks } = useCatalog();
  const faults = blocks.filter((block) => block.family === "faults");
  const [kind, setKind] = useState("");
  const [severity, setSeverity] = useState<Record<string, number | string>>({});

  const fault = faults.find(({ name }) => name === kind) ?? faults[0];
  const parameter = fault?.parameters.find((p) => p.name === "severity");
  const suggested = fault?.suggested || Number(parameter?.default) || USUAL;
  const scale = severityScale(parameter, suggested);
  const factor = scale.percent ? 100 : 1;
  const shown = severity[fault?.name ?? ""] ?? roundTo(suggested * factor, 10);
  const wanted = typeof shown === "number" ? roundTo(shown / factor, 10) : undefined;
  const fits = wanted !== undefined && wanted >= scale.minimum && wanted <= scale.maximum;
  const unit = scale.percent ? "%" : unitText(parameter?.unit ?? "");

  return (
    <GroupForAll name="Fault" label="A fault for all">
      <NativeSelect
        {...CHOICE}
        aria-label="Fault"
        value={fault?.name ?? ""}
        data={faults.map(({ name, title }) => ({ value: name, label: title }))}
        onChange={(e) => setKind(e.currentTarget.value)}
      />
      <NumberInput
        w={96}
        aria-label={`Severity of ${fault?.title ?? "the fault"}`}
        suffix={` ${unit}`}
        step={scale.step}
        value={shown}
        error={
          fits
            ? undefined
            : `From ${severityText(scale.minimum, scale, unit)} to ${severityText(scale.maximum, scale, unit)}`
        }
        onChange={(value) => fault && setSeverity({ ...severity, [fault.name]: value })}
      />
      <Button
        size="xs"
        disabled={!fits || !fault || count === 0}
        loading={busy === fault?.title}
        onClick={() => fault && wanted !== undefined && command(fault.title, { fault: fault.name, severity: wanted })}
      >
        Inject
      </Button>
      <Button
        size="xs"
        loading={busy === "Heal all"}
        disabled={count === 0}
        onClick={() => command("Heal all", { heal: "all" })}
      >
        Heal all
      </Button>
    </GroupForAll>
  );
}
