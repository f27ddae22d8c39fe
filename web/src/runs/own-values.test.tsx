import { screen } from "@testing-library/react";
import { expect, it } from "vitest";
import type { ChangedValue } from "../api/types";
import { recordedAnswer } from "../testing/recorded";
import { mount } from "../testing/render";
import { changeText, OwnValues } from "./own-values";

const run = await recordedAnswer("run");

const severity: ChangedValue = { path: "events.1.severity", before: 0.5, value: 0.8 };
const noise: ChangedValue = { path: "sensors.ideal.noise_um", before: 0.05, value: 0.15 };

it.each<[ChangedValue, string]>([
  [severity, "severity 0.5 → 0.8"],
  [noise, "noise 0.05 → 0.15 µm"],
  [{ path: "events.0.profile.duration_ms", before: 10, value: 20 }, "duration 10 → 20 ms"],
  [{ path: "controller.kind", before: "open_loop", value: "pid" }, "controller kind open loop → pid"],
  [{ path: "sensors.ideal.delay_ticks", before: null, value: 3 }, "delay ticks 3"],
  [{ path: "sensors.ideal.always", before: false, value: true }, "sensors ideal always false → true"],
])("says a value that a run changes: %o", (change, words) => {
  expect(changeText(change).replaceAll(/\s/g, " ")).toBe(words);
});

it("lists the values of a run, and has them whole in its title", () => {
  mount(<OwnValues run={{ ...run, changed: [noise, severity] }} />);
  const words = "noise 0.05 → 0.15\u00a0µm, severity 0.5 → 0.8";
  expect(screen.getByTitle(words.replace("\u00a0", " "))).toHaveTextContent(words.replace("\u00a0", " "));
});

it("shows nothing for a run that changes nothing", () => {
  const { container } = mount(<OwnValues run={{ ...run, changed: [] }} />);
  expect(container.querySelector("span")).toBeEmptyDOMElement();
});
