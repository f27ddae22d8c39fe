import { ActionIcon, Menu } from "@mantine/core";
import { IconDownload } from "@tabler/icons-react";
import type { RefObject } from "react";
import { useBench } from "../../stream/bench-store";
import { pngOf, saveFile } from "../../ui/save-file";
import type { ScopePlot } from "./scope-plot";
import { scopeSvg } from "./scope-svg";

/** What the scope shows as a file: a picture with titled axes and events, or every sample of the span. */
export function ExportMenu({ plot }: { plot: RefObject<ScopePlot | undefined> }) {
  const bench = useBench((s) => s.bench);
  const draw = () => {
    const picture = plot.current?.picture();
    return picture && scopeSvg(picture, bench?.title ?? "CombBench");
  };
  const stem = `${bench?.scenario_id ?? "scope"}-${plot.current ? Math.round(plot.current.span.start) : 0}`;
  const png = async () => {
    const svg = draw();
    if (svg) saveFile(`${stem}.png`, await pngOf(svg));
  };
  const svg = () => {
    const text = draw();
    if (text) saveFile(`${stem}.svg`, new Blob([text], { type: "image/svg+xml" }));
  };
  const trace = (format: string) => {
    const picture = plot.current?.picture();
    if (!picture || !bench) return;
    const query = new URLSearchParams({
      format,
      signals: picture.traces.map((t) => t.name).join(","),
      start_tick: String(Math.max(bench.first_tick, Math.floor(picture.span.start))),
      end_tick: String(Math.ceil(picture.span.end)),
    });
    window.location.assign(`/api/v1/benches/${bench.id}/trace?${query}`);
  };
  return (
    <Menu position="bottom-end" shadow="md">
      <Menu.Target>
        <ActionIcon size={26} variant="default" aria-label="Export" title="Save what is shown as a file">
          <IconDownload size={15} />
        </ActionIcon>
      </Menu.Target>
      <Menu.Dropdown>
        <Menu.Label>Picture, with axes and events</Menu.Label>
        <Menu.Item onClick={png}>PNG</Menu.Item>
        <Menu.Item onClick={svg}>SVG</Menu.Item>
        <Menu.Divider />
        <Menu.Label>Every sample of the span</Menu.Label>
        {["csv", "parquet", "npz", "mat"].map((format) => (
          <Menu.Item key={format} onClick={() => trace(format)}>
            {format.toUpperCase()}
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}
