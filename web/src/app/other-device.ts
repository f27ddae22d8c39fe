import { notifications } from "@mantine/notifications";
import { api } from "../api/api";
import { ApiError } from "../api/client";
import { hasAxes } from "../api/fits";
import { may } from "../api/me";
import type { Bench, Device, Document, LogEntry } from "../api/types";
import { announce } from "../bench/announce";
import { titleOf } from "../bench/flag-words";
import { openInstead } from "../bench/open-bench";
import { benchOf, firstLookOf, isGyroscope } from "../designer/design";
import { useBench } from "../stream/bench-store";
import { currentEvents } from "../stream/event-log";

/** The plant of a bench by its name in the catalogue. */
export const plantOf = (bench: Bench): string =>
  String((bench.parameters.plant as Document | undefined)?.model ?? (hasAxes(bench) ? "gyroscope" : "linear"));

/** Whether there is a bench for any device of this kind; a transfer function is tied to its scenario. */
export const hasUsualBench = (device: Device): boolean => isGyroscope(device) || device.plants.includes("linear");

/** Begin the bench again with another device. Faults and the controller come along where they suit; one notice names the rest. */
export async function beginWith(device: Device): Promise<void> {
  const { bench, events } = useBench.getState();
  if (!bench) return;
  const made = await make(bench, device);
  const lost = await takeAlong(bench, made, ownFaults(bench, events));
  await openInstead(made.id);
  const title = `The bench begins with ${device.title}`;
  announce(`${title}.`);
  if (lost.length === 0) return;
  notifications.show({ title, message: `Not kept, because it does not suit: ${lost.join(", ")}.`, autoClose: 8000 });
}

/** A bench with the device: as the one before is set, or the first look at such a device where the plant is for others. */
function make(bench: Bench, device: Device): Promise<Bench> {
  const set = { device: { id: device.id } };
  if (!device.plants.includes(plantOf(bench))) {
    if (isGyroscope(device)) return api.createBench(firstLookOf(device));
    const usual = benchOf(set, device.title, device.metrics);
    return api.createBench({ ...usual, set: { ...usual.set, title: device.title } });
  }
  if (may("teach")) return api.variant(bench.id, set);
  const kept = { ...set, "controller.kind": bench.controller };
  return api.createBench({ scenario: bench.scenario_id, set: kept, paused: false, quiet_lead: true });
}

/** The faults that act and that the scenario does not bring again by itself. */
const ownFaults = ({ faults }: Bench, events: readonly LogEntry[]): Bench["faults"] => {
  const injected = currentEvents(events).filter(({ kind }) => kind === "inject");
  const last = (name: string) =>
    injected.findLast(({ command }) => command && "fault" in command && command.fault === name);
  return faults.filter(({ name }) => last(name)?.actor !== "scenario");
};

/** Inject faults on a new bench; the titles of the faults it refuses, and of the controller if it has none of that name. */
async function takeAlong(from: Bench, to: Bench, faults: Bench["faults"]): Promise<string[]> {
  const lost = to.controllers.includes(from.controller) ? [] : [titleOf("control", from.controller)];
  for (const { name, severity, profile, parameters } of faults) {
    const inject = { fault: name, severity, profile, parameters } as Parameters<typeof api.command>[1];
    try {
      await api.command(to.id, inject);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      lost.push(titleOf("faults", name));
    }
  }
  return lost;
}
