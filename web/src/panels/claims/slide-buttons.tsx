import { Button } from "@mantine/core";
import type { Claim, ClaimList } from "../../api/types";
import { useBusy } from "../../bench/use-busy";
import { fileStem } from "../../picture/picture";
import { pngOf, saveFile } from "../../ui/save-file";
import { slideSvg } from "./slide";
import { slideTraces } from "./slide-traces";

const RATIO = 1.5;

/** The claim as one slide, in one click. */
export function SlideButtons({ claim, list }: { claim: Claim; list: ClaimList }) {
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
