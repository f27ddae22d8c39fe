import { type Ref, useImperativeHandle, useRef } from "react";
import styles from "./device-plan.module.css";
import { isFaulted, type PlanPart } from "./plan-parts";

/** Moves the drawn shuttle from where it rests, in um of the drawing. */
export interface Moving {
  move(x: number, y?: number): void;
}

interface DevicePlanProps {
  parts: readonly PlanPart[];
  /** Names of the parts on which a fault acts. */
  faulted?: ReadonlySet<string>;
  moving?: Ref<Moving>;
}

const NONE: ReadonlySet<string> = new Set();

/** The device from above, as parts of an SVG picture in um. */
export function DevicePlan({ parts, faulted = NONE, moving }: DevicePlanProps) {
  const paths = useRef<(SVGPathElement | null)[]>([]);
  useImperativeHandle(moving, () => ({
    move: (x, y = 0) => {
      parts.forEach(({ follow }, i) => {
        if (follow) paths.current[i]?.setAttribute("transform", follow(x, y));
      });
    },
  }));
  return parts.map((part, i) => (
    <path
      // biome-ignore lint/suspicious/noArrayIndexKey: a device has always the same parts
      key={i}
      ref={(path) => {
        paths.current[i] = path;
      }}
      d={part.path}
      className={styles[part.look]}
      data-fault={isFaulted(part, faulted) || undefined}
    />
  ));
}
