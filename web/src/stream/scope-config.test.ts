import { expect, it } from "vitest";
import { DEFAULT_TRIGGER, onBench, scopeConfig } from "./scope-config";

const signals = ["rate.rate", "whole_angle.rate", "force_to_rebalance.rate"].map((name) => ({ name }));

it("shows the controller that drives, whichever that is", () => {
  const config = scopeConfig(["rate.rate", "@active.rate"]);
  expect(onBench(config, signals, ["whole_angle"]).signals).toEqual(["rate.rate", "whole_angle.rate"]);
  expect(onBench(config, signals, ["force_to_rebalance"]).signals[1]).toBe("force_to_rebalance.rate");
});

it("shows the controllers that drove before as well, at most three in all", () => {
  const config = scopeConfig(["rate.rate", "@active.rate"]);
  const controllers = ["whole_angle", "force_to_rebalance", "whole_angle", "open", "first"];
  const shown = ["rate.rate", "whole_angle.rate", "force_to_rebalance.rate", "open.rate"];
  expect(onBench(config, signals, controllers).signals).toEqual(shown);
});

it("triggers on what is shown where the bench lacks the signal of the trigger", () => {
  expect(onBench(scopeConfig(["rate.rate"]), signals, []).trigger).toEqual({ ...DEFAULT_TRIGGER, signal: "rate.rate" });
  const resonator = [{ name: "reference.voltage" }];
  expect(onBench(scopeConfig(["drive.voltage"]), resonator, []).trigger).toEqual(DEFAULT_TRIGGER);
});
