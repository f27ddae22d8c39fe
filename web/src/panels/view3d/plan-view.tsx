import { Box } from "@mantine/core";
import { type Ref, useImperativeHandle, useMemo, useRef } from "react";
import { api } from "../../api/api";
import { hasAxes } from "../../api/fits";
import { useAsked } from "../../api/queries";
import type { Design } from "../../api/types";
import { deviceDrawing } from "../../picture/device-drawing";
import { DevicePlan, type Moving } from "../../picture/device-plan";
import { useBench } from "../../stream/bench-store";
import { useFeed } from "../../stream/use-feed";
import { formatNumber } from "../../ui/format";
import { useActingFaults } from "../schematic/use-live-values";
import { Magnifier } from "./magnifier";

const MARGIN = 14;
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
  const faulted = new Set(acting.flatMap(({ shows }) => shows ?? []));
  const { geometry, isStandIn } = useGeometry(isFlat, device, environment);
  const drawing = useMemo(() => geometry && deviceDrawing(geometry), [geometry]);
  const moving = useRef<Moving>(null);
  const frames = useRef<{ move(x: number, y: number): void }>(null);
  const times = useRef<HTMLSpanElement>(null);
  const magnifier = useRef(new Magnifier());
  const signals = isFlat ? FLAT : AXES;
  const subscription = useMemo(() => ({ mode: "roll" as const, signals, window_ms: 0.5, width: 2 }), [signals]);
  const width = isFlat ? (drawing?.width ?? 0) : FRAME_BOX[2];
  useFeed(subscription, ({ latest: [x, y = 0] }) => {
    if (!width || !Number.isFinite(x) || !Number.isFinite(y)) return;
    const factor = magnifier.current.of(Math.hypot(x, y), width);
    if (times.current) times.current.textContent = `, motion ×${formatNumber(factor, 0)}`;
    moving.current?.move(factor * x);
    frames.current?.move(factor * x, -factor * y);
  });
  const box = drawing ? boxAround(drawing) : FRAME_BOX;
  const said = acting.map(({ title }) => title).join(", ");
  return (
    <figure className="view">
      <svg
        viewBox={box.join(" ")}
        style={{ flex: 1, width: "100%", minHeight: 0 }}
        role="img"
        aria-label={`The device from above${said && `, with ${said}`}`}
      >
        {isFlat ? (
          drawing && <DevicePlan drawing={drawing} faulted={faulted} moving={moving} />
        ) : (
          <FramePlan faulted={acting.length > 0} moving={frames} />
        )}
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

const boxAround = ({ width, height }: { width: number; height: number }) => [
  -width / 2 - MARGIN,
  -height / 2 - MARGIN,
  width + 2 * MARGIN,
  height + 2 * MARGIN,
];

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

const PLATE = 44;
const NEAR = 62;
const FAR = 76;
const DRIVE = `M${NEAR} ${-NEAR}H${FAR}V${NEAR}H${NEAR}ZM${-NEAR} ${-NEAR}H${-FAR}V${NEAR}H${-NEAR}Z`;
const SENSE = `M${-NEAR} ${NEAR}V${FAR}H${NEAR}V${NEAR}ZM${-NEAR} ${-NEAR}V${-FAR}H${NEAR}V${-NEAR}Z`;

interface FramePlanProps {
  faulted: boolean;
  moving: Ref<{ move(x: number, y: number): void }>;
}

/** A gyroscope from above, not to scale: the drive frame moves along x, the sense frame along y, the plate along both. */
function FramePlan({ faulted, moving }: FramePlanProps) {
  const drive = useRef<SVGPathElement>(null);
  const sense = useRef<SVGPathElement>(null);
  const plate = useRef<SVGRectElement>(null);
  useImperativeHandle(moving, () => ({
    move: (x, y) => {
      drive.current?.setAttribute("transform", `translate(${x} 0)`);
      sense.current?.setAttribute("transform", `translate(0 ${y})`);
      plate.current?.setAttribute("transform", `translate(${x} ${y})`);
    },
  }));
  return (
    <>
      <path ref={drive} fill="#cc79a7" d={DRIVE} />
      <path ref={sense} fill="#009e73" d={SENSE} />
      <rect
        ref={plate}
        fill={faulted ? "var(--alarm)" : "#56b4e9"}
        x={-PLATE}
        y={-PLATE}
        width={2 * PLATE}
        height={2 * PLATE}
      />
    </>
  );
}

const REACH = 110;

/** The box of the picture, and the width that motions are drawn for. */
export const FRAME_BOX = [-REACH, -REACH, 2 * REACH, 2 * REACH];
