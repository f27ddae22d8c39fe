import { type Ref, useImperativeHandle, useRef } from "react";

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
export function FramePlan({ faulted, moving }: FramePlanProps) {
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
