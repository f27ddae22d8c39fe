import { Box } from "@mantine/core";
import { useMemo, useRef } from "react";
import { api } from "../../api/api";
import { hasAxes } from "../../api/fits";
import { useAsked } from "../../api/queries";
import type { Design } from "../../api/types";
import { deviceDrawing } from "../../picture/device-drawing";
import { DevicePlan, type Moving } from "../../picture/device-plan";
import { boxAround, GYROSCOPE_BOX, GYROSCOPE_PARTS, resonatorParts } from "../../picture/plan-parts";
import { useBench } from "../../stream/bench-store";
import { useFeed } from "../../stream/use-feed";
import { formatNumber } from "../../ui/format";
import { useActingFaults } from "../schematic/use-live-values";
import { Magnifier } from "./magnifier";

/** Shown in place of a device without a drawing. */
const STAND_IN = "lcr-350";
const FLAT = ["plant.displacement"];
const AXES = ["plant.x", "plant.y"];

/** The device from above where there is no 3D view: it moves with the stream, and the part with a fault is red. */
export function PlanView({ because }: { because: string }) {
  const device = useBench((s) => s.bench?.parameters.device as Design["device"]);
  const environment = useBench((s) => s.bench?.parameters.environment as Design["environment"]);
  const isFlat = useBench((s) => !hasAxes(s.bench));
  const acting = useActingFaults();
  const faulted = new Set(acting.flatMap(({ shows }) => (isFlat ? (shows ?? []) : "plate")));
  const { geometry, isStandIn } = useGeometry(isFlat, device, environment);
  const drawing = useMemo(() => geometry && deviceDrawing(geometry), [geometry]);
  const parts = useMemo(() => (isFlat ? drawing && resonatorParts(drawing) : GYROSCOPE_PARTS), [isFlat, drawing]);
  const moving = useRef<Moving>(null);
  const times = useRef<HTMLSpanElement>(null);
  const magnifier = useRef(new Magnifier());
  const signals = isFlat ? FLAT : AXES;
  const subscription = useMemo(() => ({ mode: "roll" as const, signals, window_ms: 0.5, width: 2 }), [signals]);
  const width = isFlat ? (drawing?.width ?? 0) : GYROSCOPE_BOX[2];
  useFeed(subscription, ({ latest: [x, y = 0] }) => {
    if (!width || !Number.isFinite(x) || !Number.isFinite(y)) return;
    const factor = magnifier.current.of(Math.hypot(x, y), width);
    if (times.current) times.current.textContent = `, motion ×${formatNumber(factor, 0)}`;
    moving.current?.move(factor * x, -factor * y);
  });
  const box = drawing ? boxAround(drawing) : GYROSCOPE_BOX;
  const said = acting.map(({ title }) => title).join(", ");
  return (
    <figure className="view">
      <svg
        viewBox={box.join(" ")}
        style={{ flex: 1, width: "100%", minHeight: 0 }}
        role="img"
        aria-label={`The device from above${said && `, with ${said}`}`}
      >
        {parts && <DevicePlan parts={parts} faulted={faulted} moving={moving} />}
      </svg>
      <Box component="figcaption" className="note" p="4px 10px 8px">
        {said && (
          <Box component="b" c="var(--alarm)">
            {said}.{" "}
          </Box>
        )}
        {because}
        <span ref={times} style={{ whiteSpace: "nowrap" }} />.
        {isStandIn && " This device has no drawing; LCR-350 is shown."}
      </Box>
    </figure>
  );
}

/** The drawing of the device of the bench; another one where it has none. */
function useGeometry(wanted: boolean, device: Design["device"], environment: Design["environment"]) {
  const own = useAsked(wanted && device ? ["drawing", device, environment] : undefined, () =>
    api.evaluate({ device, environment: environment ?? {} }),
  );
  const isStandIn = own.refusal !== undefined || own.answer?.geometry === null;
  const other = useAsked(isStandIn ? ["drawing", STAND_IN] : undefined, () =>
    api.evaluate({ device: { id: STAND_IN }, environment: {} }),
  );
  return { geometry: (isStandIn ? other : own).answer?.geometry ?? undefined, isStandIn };
}
