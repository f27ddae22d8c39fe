import { expect, it } from "vitest";
import type { LogEntry } from "../api/types";
import cases from "../testing/cases/as-code.json";
import { asCode } from "./as-code";

it.each(cases.cases)("writes the command of $event.tick as the readers of these texts have it", (one) => {
  const { event, ...texts } = one;
  expect(asCode(event as unknown as LogEntry, cases.source)).toEqual(texts);
});

it("has nothing for an event without a command", () => {
  expect(asCode({ tick: 5, command: null }, cases.source)).toEqual({});
});
