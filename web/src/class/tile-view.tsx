import { ActionIcon, Box, Checkbox, Group, Menu } from "@mantine/core";
import { IconCheck, IconDots, IconHandStop, IconX } from "@tabler/icons-react";
import { memo, type ReactNode } from "react";
import { answersOf } from "../api/blind";
import type { BlockCard, HiddenAnswer, Tile, Verdict } from "../api/types";
import { cardOf } from "../api/use-catalog";
import { titleOf } from "../bench/flag-words";
import { hypothesisWords } from "../bench/hypothesis-words";
import { severityScale, severityText } from "../bench/severity";
import { sheetWords } from "../bench/sheet-words";
import { formatCount, formatPercent, formatShort } from "../ui/format";
import { SIGNALS, TRACE_COLOURS } from "../ui/palette";
import { StateDot } from "../ui/state-dot";
import { useScheme } from "../ui/use-canvas";
import { isRight, outline } from "./members";
import styles from "./tile.module.css";

/** A trace that is smaller does not fill the picture: noise is not motion. */
const LEAST_UM = 0.5;
const COLOUR = SIGNALS["plant.displacement"]?.[0] ?? 1;

interface TileActions {
  open(tile: Tile): void;
  choose(id: string, chosen: boolean): void;
  run(tile: Tile, start: boolean): void;
  lowerHand(tile: Tile): void;
  /** Hand the bench on the page over, if it is the teacher's own. */
  lend: ((tile: Tile) => void) | undefined;
  sendAway(tile: Tile): void;
}

interface TileViewProps {
  tile: Tile;
  isChosen: boolean;
  /** The catalogue has come: faults and controllers have their titles. */
  hasCatalog: boolean;
  actions: TileActions;
}

/** A student and the bench, in brief; drawn again only when something of it has changed. */
export const TileView = memo(function TileView({ tile, isChosen, actions }: TileViewProps) {
  const { id, name, hand, bench, watchers, scenario, state, controller = "", verdicts = [] } = tile;
  return (
    <li className={`column ${styles.tile}`} data-hand={hand} data-state={state ?? "none"} aria-label={name}>
      <div className={`line ${styles.head}`}>
        <Checkbox
          aria-label={`Choose ${name}`}
          checked={isChosen}
          onChange={(e) => actions.choose(id, e.currentTarget.checked)}
        />
        {bench ? (
          <button
            type="button"
            className={`cut ${styles.open}`}
            title="Open this bench"
            onClick={() => actions.open(tile)}
          >
            {name}
          </button>
        ) : (
          <b className="cut">{name}</b>
        )}
        {hand && (
          <button
            type="button"
            className={styles.hand}
            aria-label={`Lower the hand of ${name}`}
            title="Hand up; press to lower it"
            onClick={() => actions.lowerHand(tile)}
          >
            <IconHandStop size={17} />
          </button>
        )}
        <Menu position="bottom-end">
          <Menu.Target>
            <ActionIcon size={26} color="gray" aria-label={`What can be done with ${name}`}>
              <IconDots size={16} />
            </ActionIcon>
          </Menu.Target>
          <Menu.Dropdown>
            <Menu.Item disabled={!bench} onClick={() => actions.open(tile)}>
              Open the bench
            </Menu.Item>
            <Menu.Item disabled={state !== "running"} onClick={() => actions.run(tile, false)}>
              Pause
            </Menu.Item>
            <Menu.Item disabled={state !== "paused"} onClick={() => actions.run(tile, true)}>
              Start
            </Menu.Item>
            <Menu.Item disabled={!actions.lend} onClick={() => actions.lend?.(tile)}>
              Let {name} drive my bench
            </Menu.Item>
            <Menu.Divider />
            <Menu.Item onClick={() => actions.sendAway(tile)}>Send away…</Menu.Item>
          </Menu.Dropdown>
        </Menu>
      </div>
      <Group component="p" justify="space-between" gap={8} c="dimmed">
        <StateDot state={state ?? "none"}>{state ?? "no bench yet"}</StateDot>
        <Box component="span" c={watchers === 0 ? "var(--paused)" : undefined}>
          {watchers === 0 ? "offline" : formatCount(watchers, "page")}
        </Box>
      </Group>
      {bench && (
        <>
          <Trace trace={tile.trace ?? []} name={name} />
          <p className="note cut" title={scenario}>
            {scenario}
          </p>
          <p className="note">
            {titleOf("control", controller)} · <Faults faults={tile.faults ?? []} />
          </p>
          {tile.blind && tile.blind.bench === bench && <Hidden answer={tile.blind} />}
          {tile.sheet && (
            <>
              <p className="note cut" title={tile.sheet.title}>
                Sheet: {tile.sheet.title}
              </p>
              <p>{sheetWords(tile.sheet)}</p>
            </>
          )}
          {verdicts.map((verdict) => (
            <VerdictLine key={verdict.diagnoser} verdict={verdict} />
          ))}
        </>
      )}
    </li>
  );
});

/** The last of the displacement, and how far it reaches. */
function Trace({ trace, name }: { trace: [number, number][]; name: string }) {
  const scheme = useScheme();
  const { path, reach } = outline(trace, LEAST_UM);
  return (
    <div className={styles.trace}>
      <svg
        viewBox={`0 0 ${Math.max(1, trace.length - 1)} 2`}
        preserveAspectRatio="none"
        role="img"
        aria-label={`Displacement of ${name}`}
      >
        <path
          d={path}
          fill={TRACE_COLOURS[scheme][COLOUR]}
          stroke={TRACE_COLOURS[scheme][COLOUR]}
          vectorEffect="non-scaling-stroke"
        />
      </svg>
      {trace.length > 0 && <small>±{formatShort(reach, "um", 2)}</small>}
    </div>
  );
}

/** The faults that act on the device. */
function Faults({ faults }: { faults: NonNullable<Tile["faults"]> }) {
  const acting = faults.filter(({ severity }) => severity !== 0);
  if (acting.length === 0) return <span>no fault</span>;
  return (
    <Box component="b" c="var(--alarm)" fw={560}>
      {acting
        .map(({ name, severity }) => `${titleOf("faults", name)} ${strength(cardOf("faults", name), severity)}`)
        .join(", ")}
    </Box>
  );
}

function strength(fault: BlockCard | undefined, severity: number): string {
  const parameter = fault?.parameters.find((p) => p.name === "severity");
  return severityText(severity, severityScale(parameter, fault?.suggested || 0.05), parameter?.unit ?? "");
}

/** The hidden fault, the student's answer, and the points. */
function Hidden({ answer }: { answer: HiddenAnswer }) {
  const { state, said, confidence, truth, points = 0 } = answer;
  const words = (name: string) => hypothesisWords(name, answersOf(answer));
  const isHidden = state === "hidden";
  const open = isHidden ? `hidden: ${words(truth)}` : "no answer";
  return (
    <Judged
      right={said ? said === truth : undefined}
      says={said ? `says ${words(said)}, ${formatPercent(confidence ?? 0, 0)} sure` : open}
      truth={!isHidden && said !== truth && words(truth)}
    >
      {!isHidden && <small>{formatCount(Math.round(points), "point")}</small>}
    </Judged>
  );
}

/** The verdict of a diagnoser, the truth if the two differ, and how often it was right. */
function VerdictLine({ verdict }: { verdict: Verdict }) {
  const right = isRight(verdict);
  const { diagnoser, says, truth, correct_fraction, factors } = verdict;
  const known = { [diagnoser]: { kind: diagnoser, names: Object.keys(factors), factors: Object.values(factors) } };
  const words = (name: string) => hypothesisWords(name, known);
  return (
    <Judged
      right={right}
      says={`${diagnoser.replaceAll("_", " ")}: ${says === null ? "no verdict" : words(says)}`}
      truth={right !== true && (truth === null ? "none of its hypotheses" : words(truth))}
    >
      <small title="Share of samples at which the verdict was right">{formatPercent(correct_fraction, 0)}</small>
    </Judged>
  );
}

interface JudgedProps {
  right: boolean | undefined;
  says: string;
  truth: string | false;
  children: ReactNode;
}

/** An answer with a mark for right or wrong, and the truth after it. */
function Judged({ right, says, truth, children }: JudgedProps) {
  const Mark = right ? IconCheck : IconX;
  return (
    <p className={styles.verdict} data-right={right}>
      {right !== undefined && <Mark size={14} stroke={2.6} aria-label={right ? "right" : "wrong"} />}
      <span>
        {says}
        {truth !== false && (
          <Box component="span" c="dimmed">
            {" "}
            · true: {truth}
          </Box>
        )}
      </span>
      {children}
    </p>
  );
}
