import { Button, Flex, Group, NativeSelect, Stack, Text } from "@mantine/core";
import { useCallback, useEffect, useRef, useState } from "react";
import { api } from "../../api/api";
import { useMay } from "../../api/me";
import { useAnswer } from "../../api/queries";
import type { Claim, ClaimKnob, Command, ThresholdRun } from "../../api/types";
import { send, showError } from "../../bench/send";
import { Painted } from "../../picture/painted";
import type { Box, Look, Pen } from "../../picture/pen";
import { useBench } from "../../stream/bench-store";
import { formatPercent, formatShort } from "../../ui/format";
import { Knob } from "../../ui/knob";
import { metricScale } from "../../ui/metric-name";
import { unitText } from "../../ui/unit-scale";
import { paintThreshold } from "./paint-threshold";

const EVERY_MS = 300;
const isActive = (run: ThresholdRun | undefined) => run?.state === "queued" || run?.state === "running";

/** One number of the scenario over its range: where the claim holds, and the bench with another value. */
export function ThresholdView({ claim }: { claim: Claim }) {
  const [path, setPath] = useState(claim.knobs[0].path);
  const knob = claim.knobs.find((one) => one.path === path) ?? claim.knobs[0];
  return (
    <Stack gap={8} mt={10} p={10} bg="var(--raised)" bdrs="md">
      <NativeSelect
        label="Turn"
        value={knob.path}
        data={claim.knobs.map((one) => ({ value: one.path, label: labelOf(one) }))}
        onChange={(event) => setPath(event.currentTarget.value)}
      />
      <Turned key={knob.path} claim={claim} knob={knob} />
    </Stack>
  );
}

const labelOf = ({ label, path, is_fitted }: ClaimKnob) =>
  `${label}${is_fitted ? ", chosen so that it agrees" : ""} (${path})`;

function Turned({ claim, knob }: { claim: Claim; knob: ClaimKnob }) {
  const bench = useBench((s) => s.bench?.id) ?? "";
  const drives = useMay("drive");
  const [id, setId] = useState<string | undefined>(undefined);
  const [value, setValue] = useState(knob.value);
  const { value: run } = useAnswer(
    id === undefined ? undefined : ["threshold", id],
    () => api.threshold(id ?? ""),
    (now) => (isActive(now) ? EVERY_MS : undefined),
  );
  const find = () =>
    api
      .findThreshold({
        bench,
        metric: claim.metric,
        path: knob.path,
        low: knob.low,
        high: knob.high,
        scale: knob.is_log ? "log" : "linear",
      })
      .then((started) => setId(started.id), showError);
  const found = run?.found ?? undefined;
  const paint = useCallback(
    (pen: Pen, box: Box, look: Look) => found && paintThreshold(pen, box, look, { found, claim, knob, value }),
    [found, claim, knob, value],
  );
  const unit = unitText(knob.unit);
  const place = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (found) place.current?.scrollIntoView({ block: "nearest" });
  }, [found]);
  const near = found && nearest(found.tried, value);
  const scale = metricScale(claim.metric, []);
  const apply = (next: number) => {
    setValue(next);
    if (drives && knob.is_live) void send(commandFor(knob, next), `Set ${knob.label}`);
  };
  const begin = () => void send({ kind: "reset", values: { [knob.path]: value } }, "The bench begins again");
  return (
    <>
      <Group gap={8} align="end">
        {isActive(run) ? (
          <Button onClick={() => id && api.cancelThreshold(id).catch(showError)}>
            Cancel, {formatPercent(run?.progress ?? 0, 0)} done
          </Button>
        ) : (
          <Button variant="filled" onClick={() => void find()}>
            Find where it holds
          </Button>
        )}
        {run?.error && <p className="note">{run.error.message}</p>}
        {run?.state === "cancelled" && <p className="note">Cancelled.</p>}
      </Group>
      {found && (
        <>
          <Text inherit fz="md" fw={620}>
            It {found.words}
            {unit && `, in ${unit}`}.
          </Text>
          <Flex ref={place} flex="none" h={230} style={{ scrollMargin: "70px 0 120px" }}>
            <Painted label={`${claim.metric} over ${knob.label}: ${found.words}`} paint={paint} />
          </Flex>
          <p className="note">
            Hatched: {claim.is_published ? "agrees with the print" : "nothing is printed"}. Dashed: our bounds. Points:
            runs of the scenario with this value and its seed.
          </p>
        </>
      )}
      <Knob
        label={knob.label}
        unit={unit ? knob.unit : ""}
        low={knob.low}
        high={knob.high}
        step={0}
        log={knob.is_log}
        value={value}
        original={knob.value}
        note={
          near?.measured === undefined || near.measured === null
            ? undefined
            : `${scale.name} ${scale.say(near.measured)}, measured at ` +
              `${formatShort(near.value, unit ? knob.unit : "")}: ${near.holds ? "holds" : "does not hold"}`
        }
        onMove={setValue}
        onChange={apply}
      />
      {drives && (
        <Group gap={8} align="end">
          <Button onClick={begin}>Begin the bench again with it</Button>
          <p className="note">
            {knob.is_live
              ? "The slider changes the bench as it runs. Earlier samples count too, until a restart."
              : "This number cannot change while the bench runs."}
          </p>
        </Group>
      )}
    </>
  );
}

/** The command for another value on a live bench. */
export const commandFor = ({ path, fault }: ClaimKnob, value: number): Command =>
  (fault ? { fault, severity: value } : { set: { [path]: value } }) as Command;

/** The run whose value is nearest. */
export const nearest = <T extends { value: number }>(tried: readonly T[], value: number): T | undefined =>
  tried.reduce<T | undefined>(
    (best, one) => (best === undefined || Math.abs(one.value - value) < Math.abs(best.value - value) ? one : best),
    undefined,
  );
