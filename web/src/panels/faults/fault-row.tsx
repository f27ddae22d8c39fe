import { Box, Button } from "@mantine/core";
import { IconChevronRight } from "@tabler/icons-react";
import { useState } from "react";
import type { ActiveFault, BlockCard } from "../../api/types";
import { send } from "../../bench/send";
import { severityScale, severityText } from "../../bench/severity";
import { useBench } from "../../stream/bench-store";
import { formatMoment, formatShort } from "../../ui/format";
import { parameterTitle } from "../card/parameter-title";
import { draftSeverity, injectCommand, newDraft, ownParameters, refusals } from "./fault-draft";
import { FaultForm } from "./fault-form";
import styles from "./faults.module.css";

interface FaultRowProps {
  fault: BlockCard;
  active: ActiveFault | undefined;
  open: boolean;
  onToggle(): void;
}

/** One fault: inject with one press, or open it to choose how and when. */
export function FaultRow({ fault, active, open, onToggle }: FaultRowProps) {
  const parameter = fault.parameters.find((p) => p.name === "severity");
  const suggested = fault.suggested || Number(parameter?.default) || 0.05;
  const [changed, setDraft] = useState(() => newDraft(suggested));
  const first = useBench((s) => s.bench?.signals[0]?.name) ?? "";
  const draft = { ...changed, when: { ...changed.when, signal: changed.when.signal || first } };
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  const scale = severityScale(parameter, suggested);
  const unit = parameter?.unit ?? "";
  const inject = () => {
    if (Object.keys(refusals(draft, scale, unit)).length > 0) {
      if (!open) onToggle(); // the form has the refusals
      return;
    }
    void send(
      injectCommand(fault.name, draft),
      `${fault.title} ${draftSeverity(draft, scale, unit)} ${draft.moment === "now" ? "injected" : "is waiting"}`,
    );
  };

  return (
    <li className={styles.fault} data-active={active !== undefined}>
      <Box className="row" mih={40} p="4px 8px 4px 5px" style={{ justifyContent: "flex-end" }}>
        <button type="button" className={`line ${styles.name}`} aria-expanded={open} onClick={onToggle}>
          <IconChevronRight size={14} className={styles.chevron} aria-hidden="true" />
          <span>{fault.title}</span>
        </button>
        {active ? (
          <Box component="span" className="line" flex="none">
            <Box component="b" c="var(--alarm)" fw={650} ta="right" style={{ whiteSpace: "nowrap" }}>
              {severityText(active.severity, scale, unit)}
              {active.since_tick !== undefined && <small> since {formatMoment(active.since_tick * dtMs)}</small>}
            </Box>
            <Button onClick={() => send({ heal: [fault.name] }, `${fault.title} healed`)}>Heal</Button>
          </Box>
        ) : (
          <Button
            variant="light"
            onClick={inject}
            aria-label={`Inject ${draftSeverity(draft, scale, unit)}: ${fault.title}`}
          >
            Inject {draftSeverity(draft, scale, unit)}
          </Button>
        )}
      </Box>
      {active && <Chosen fault={fault} active={active} />}
      {open && (
        <FaultForm
          fault={fault}
          parameter={parameter}
          scale={scale}
          suggested={suggested}
          draft={draft}
          onChange={setDraft}
          onInject={inject}
        />
      )}
    </li>
  );
}

/** Chosen parameters of an acting fault, such as its place. */
function Chosen({ fault, active }: { fault: BlockCard; active: ActiveFault }) {
  const values = (active as { parameters?: Record<string, unknown> }).parameters ?? {};
  const words = ownParameters(fault)
    .filter((p) => values[p.name] !== undefined && values[p.name] !== null)
    .map((p) => {
      const value = values[p.name];
      return `${parameterTitle(p).toLowerCase()}: ${typeof value === "number" ? formatShort(value, p.unit) : String(value)}`;
    });
  return (
    words.length > 0 && (
      <Box component="p" className="wrong" p="0 8px 6px 27px">
        {words.join(", ")}
      </Box>
    )
  );
}
