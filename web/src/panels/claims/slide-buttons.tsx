import { Button } from "@mantine/core";
import { useState } from "react";
import type { Claim, ClaimList } from "../../api/types";
import { showError } from "../../bench/send";
import { fileStem } from "../../picture/picture";
import { pngOf, saveFile } from "../../ui/save-file";
import { slideSvg } from "./slide";
import { slideTraces } from "./slide-traces";

const RATIO = 1.5;

/** The claim as one slide, in one click. */
export function SlideButtons({ claim, list }: { claim: Claim; list: ClaimList }) {
  const [isMaking, setMaking] = useState(false);
  const keep = async (kind: "png" | "svg") => {
    setMaking(true);
    try {
      const svg = slideSvg(claim, list, await slideTraces(claim, list));
      const content = kind === "png" ? await pngOf(svg, RATIO) : new Blob([svg], { type: "image/svg+xml" });
      saveFile(`${fileStem(`${list.scenario_id}-${claim.metric}`)}-slide.${kind}`, content);
    } catch (error) {
      showError(error);
    } finally {
      setMaking(false);
    }
  };
  return (
    <Button.Group>
      {(["png", "svg"] as const).map((kind) => (
        <Button
          key={kind}
          disabled={isMaking}
          title="One slide, 16:9: the words as printed, the traces over the marks, and what came of it"
          onClick={() => void keep(kind)}
        >
          {kind === "png" ? "Slide PNG" : "SVG"}
        </Button>
      ))}
    </Button.Group>
  );
}
