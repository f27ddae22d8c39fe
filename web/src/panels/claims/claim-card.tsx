import { Box, Button, Group } from "@mantine/core";
import { IconCheck, IconClock, IconX } from "@tabler/icons-react";
import { useMay } from "../../api/me";
import type { Claim, ClaimList } from "../../api/types";
import { addScope } from "../../bench/dock";
import { placeIn } from "../../bench/printed";
import { useBusy } from "../../bench/use-busy";
import { fileStem } from "../../picture/picture";
import { Figure } from "../../ui/figure";
import { keepUnits } from "../../ui/format";
import { pngOf, saveFile } from "../../ui/save-file";
import { Verdict } from "../../ui/verdict";
import { partnersOf } from "./claim-signals";
import { claimWords, stateWords } from "./claim-words";
import styles from "./claims.module.css";
import { slideSvg } from "./slide";
import { slideTraces } from "./slide-traces";
import { ThresholdView } from "./threshold-view";

const ICONS = {
  holds: <IconCheck size={20} stroke={2.8} />,
  fails: <IconX size={20} stroke={2.8} />,
  "not yet": <IconClock size={18} stroke={2} />,
};

const COLOURS = { holds: "var(--running)", fails: "var(--alarm)", "not yet": "dimmed" };

interface ClaimCardProps {
  claim: Claim;
  list: ClaimList;
  isOpen: boolean;
  onOpen(isOpen: boolean): void;
}

/** One claim: ticked or crossed, printed and measured side by side, and the range where it holds. */
export function ClaimCard({ claim, list, isOpen, onOpen }: ClaimCardProps) {
  const teaches = useMay("teach");
  const words = claimWords(claim);
  const places = [...new Set(claim.marks.map(placeIn))];
  const said = places.map((place) => {
    const here = claim.marks.filter((mark) => placeIn(mark) === place);
    return `${[...new Set(here.map((mark) => `“${mark.words}”`))].join(", ")}: ${place}`;
  });
  const readings = [...new Set(claim.marks.flatMap(({ reading }) => (reading ? [reading] : [])))];
  const drawn = [...new Set(claim.marks.flatMap(({ signal, problem }) => (problem ? [] : [signal])))];
  const problems = [...new Set(claim.marks.flatMap(({ problem }) => (problem ? [problem] : [])))];
  return (
    <li className={styles.card} aria-label={`${words.name}: ${stateWords(claim)}`}>
      <Box component="span" flex="none" w={26} c={COLOURS[claim.state]} title={stateWords(claim)}>
        {ICONS[claim.state]}
      </Box>
      <Box flex={1} miw={0}>
        <Group gap="4px 10px" align="baseline">
          <h3>{words.name}</h3>
          {claim.state !== "not yet" && <Verdict verdict={claim.verdict} borneOut />}
        </Group>
        <dl className={styles.numbers}>
          <Figure name="printed">
            {words.printed}
            {claim.published && <small>“{claim.published}”</small>}
          </Figure>
          <Figure name="expected">{words.expected}</Figure>
          <Figure name="measured" fz="md" fw={650}>
            {words.measured}
            {claim.state !== "not yet" && claim.as_expected === false && claim.is_published && (
              <small>other than expected</small>
            )}
          </Figure>
        </dl>
        {said.map((text) => (
          <Box component="p" key={text} m="2px 0">
            {text}
          </Box>
        ))}
        {[
          ...(readings.length > 0 ? [`Drawn: ${readings.join("; ")}.`] : []),
          ...problems.map((text) => `Not drawn: ${text}.`),
          ...(claim.note ? [`Why: ${keepUnits(claim.note)}.`] : []),
          ...(claim.fitted.length > 0 ? [`Chosen so that it agrees: ${claim.fitted.join(", ")}.`] : []),
        ].map((text) => (
          <Box component="p" key={text} className="remark" m="2px 0">
            {text}
          </Box>
        ))}
        <Box className="row" mt={8}>
          {teaches && claim.knobs.length > 0 && (
            <Button variant="light" aria-expanded={isOpen} onClick={() => onOpen(!isOpen)}>
              Where does it hold?
            </Button>
          )}
          {drawn.length > 0 && (
            <Button
              title={`Open a scope on ${drawn.join(", ")}`}
              onClick={() => addScope("Printed", [...drawn, ...partnersOf(drawn)], "time")}
            >
              Show on a scope
            </Button>
          )}
          <SlideButtons claim={claim} list={list} />
        </Box>
        {isOpen && <ThresholdView claim={claim} />}
      </Box>
    </li>
  );
}

const RATIO = 1.5;

/** The claim as one slide, in one click. */
function SlideButtons({ claim, list }: { claim: Claim; list: ClaimList }) {
  const [isMaking, during] = useBusy();
  const keep = (kind: "png" | "svg") =>
    during(async () => {
      const svg = slideSvg(claim, list, await slideTraces(claim, list));
      const content = kind === "png" ? await pngOf(svg, RATIO) : new Blob([svg], { type: "image/svg+xml" });
      saveFile(`${fileStem(`${list.scenario_id}-${claim.metric}`)}-slide.${kind}`, content);
    });
  return (
    <Button.Group>
      {(["png", "svg"] as const).map((kind) => (
        <Button
          key={kind}
          disabled={isMaking}
          title="One slide, 16:9: the words as printed, the traces over the marks, and the result"
          onClick={() => void keep(kind)}
        >
          {kind === "png" ? "Slide PNG" : "SVG"}
        </Button>
      ))}
    </Button.Group>
  );
}
