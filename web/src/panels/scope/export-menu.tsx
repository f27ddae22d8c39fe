import { Menu } from "@mantine/core";
import type { ReactNode, RefObject } from "react";
import { ticketed } from "../../api/launch";
import { useServed } from "../../api/me";
import { PictureMenu } from "../../picture/picture-menu";
import { useBench } from "../../stream/bench-store";
import type { CaptureMark } from "../../stream/wire";
import { TRACE_FORMATS } from "../../ui/downloads";
import { DIFFERENCE, scopePicture } from "./paint-scope";
import type { ScopePlot } from "./scope-plot";

interface ExportMenuProps {
  plot: RefObject<ScopePlot | undefined>;
  /** The capture that the scope shows. */
  capture: CaptureMark | undefined;
  /** Trigger and measure. */
  tools: ReactNode;
}

/** Files of the scope: a picture with titled axes and events, or every sample of the span. */
export function ExportMenu({ plot, capture, tools }: ExportMenuProps) {
  const served = useServed();
  const take = () => {
    const { bench } = useBench.getState();
    const shown = plot.current?.picture();
    const stem = `${bench?.scenario_id ?? "scope"}-${Math.round(shown?.span.start ?? 0)}`;
    return shown && scopePicture(shown, bench?.title ?? "CombBench", stem);
  };
  const trace = (format: string) => {
    const { bench } = useBench.getState();
    const picture = plot.current?.picture();
    if (!picture || !bench) return;
    const query = new URLSearchParams([
      ["format", format],
      ...picture.traces
        .filter(({ behind, unit }) => behind === undefined && !unit.startsWith(DIFFERENCE))
        .map((t) => ["signals", t.name]),
      ["start_tick", String(Math.max(capture?.start_tick ?? bench.first_tick, Math.floor(picture.span.start)))],
      ["end_tick", String(Math.min(capture?.end_tick ?? Number.MAX_SAFE_INTEGER, Math.ceil(picture.span.end)))],
    ]);
    ticketed(`./api/v1/benches/${bench.id}/trace?${query}`).then((address) => window.location.assign(address));
  };
  return (
    <PictureMenu take={take} tools={tools}>
      {served && (
        <>
          <Menu.Divider />
          <Menu.Label>Every sample of the span</Menu.Label>
          {TRACE_FORMATS.map((format) => (
            <Menu.Item key={format} onClick={() => trace(format)}>
              {format.toUpperCase()}
            </Menu.Item>
          ))}
        </>
      )}
    </PictureMenu>
  );
}
