import { describe, expect, it } from "vitest";
import { CANVAS, contrast, inkOn, type Scheme, TRACE_COLOURS } from "./palette";

describe.each(["dark", "light"] as Scheme[])("%s", (scheme) => {
  it("traces stand out from the panel (3:1, graphics)", () => {
    for (const colour of TRACE_COLOURS[scheme])
      expect(contrast(colour, CANVAS[scheme].panel), colour).toBeGreaterThanOrEqual(3);
  });

  it("a name is readable on a band of any of them (4.5:1)", () => {
    for (const colour of TRACE_COLOURS[scheme])
      expect(contrast(inkOn(colour), colour), colour).toBeGreaterThanOrEqual(4.5);
  });

  it("text is readable (4.5:1)", () => {
    for (const key of ["text", "muted", "accent", "alarm"] as const)
      expect(contrast(CANVAS[scheme][key], CANVAS[scheme].panel), key).toBeGreaterThanOrEqual(4.5);
  });
});
