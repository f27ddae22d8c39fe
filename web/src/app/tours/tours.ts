import { api } from "../../api/api";
import { unless } from "../../api/client";
import type { Command } from "../../api/types";
import { dockNow, panelWith, showPanel } from "../../bench/dock";
import { send } from "../../bench/send";
import { setPage } from "../../bench/view-store";
import { askLatest } from "../../bench/why";
import { isActive } from "../../runs/jobs";
import { useBench } from "../../stream/bench-store";
import { currentEvents } from "../../stream/event-log";

/** One bubble of a tour: its target, and an action on the page before it appears. */
export interface TourStep {
  title: string;
  text: string;
  at(): Element | undefined;
  does?(): unknown;
  /** A condition of the bench to wait for after that. */
  until?(): boolean;
}

export interface Tour {
  title: string;
  steps: TourStep[];
}

const find = (selector: string) => () => document.querySelector(selector) ?? undefined;
/** The group of panels that has a view. */
const panel = (view: string) => () => panelWith(view)?.group.element;
const show = (view: string) => () => showPanel(view, "faults");
const command = (one: Command) => () => send(one);
const found = (name: string) => () =>
  currentEvents(useBench.getState().events).some(({ kind, new: value }) => kind === "recognised" && value === name);
const drives = (name: string) => () => useBench.getState().bench?.controller === name;
const injectMass = command({ fault: "added_mass", severity: 0.05 } as Command);

/** The run that a tour has started, once the server has answered; none where it was there already. */
let run: Promise<string | undefined> | undefined;

async function startRun(): Promise<string | undefined> {
  const there = await api.runs({ scenario: "ch1-step" });
  const { id } = await api.startRun({ scenario: "ch1-step" });
  return there.some((one) => one.id === id) ? undefined : id;
}

/** Remove the run of a tour from the server. */
export async function forgetRun(): Promise<void> {
  const left = await run?.catch(() => undefined); // said already
  run = undefined;
  if (!left) return;
  let state: string = "running";
  // cancelling may take longer than the server lets a request wait; it is refused from the end of the run on, and only
  // a little later the run counts as ended and can be removed
  while (isActive(state)) state = (await api.cancelRun(left).catch(unless(409)))?.state ?? (await api.run(left)).state;
  await api.removeRuns([left]);
}

export const TOURS: Tour[] = [
  {
    title: "First look round",
    steps: [
      {
        title: "A bench that runs",
        text: "This is a bench of the tour's own; yours waits. A voltage shakes a plate on thin beams, 2000 times a second.",
        at: find("header h1 ~ button"),
      },
      {
        title: "Run, step, pace",
        text: "Run and pause, step one tick or one period, and set how much device time passes in a second.",
        at: find("[role=timer]"),
      },
      {
        title: "The motion",
        text: "The plate, the sensor and the model. Drag to look at the past; LIVE comes back to now.",
        at: panel("time"),
      },
      {
        title: "A fault",
        text: "The plate has just become 5 % heavier, as if dust had fallen on it. Each fault here is one press.",
        at: panel("faults"),
        does: injectMass,
      },
      {
        title: "The verdict",
        text: "Six filters watch. The lane of mass +5 % has taken over, and the delay is printed at the switch.",
        at: panel("lanes"),
        until: found("m+5"),
      },
      {
        title: "Where to go next",
        text: "The gallery has every experiment of the text. The key ? opens the keys, and the other tours.",
        at: find("nav[aria-label=Pages]"),
      },
    ],
  },
  {
    title: "Faults",
    steps: [
      {
        title: "The list of faults",
        text: "Active faults are on top. Open a row to choose severity, start, and step, ramp or intermittent.",
        at: panel("faults"),
      },
      {
        title: "Damping +30 %",
        text: "The air has become thicker. The red band says since when; the swing is a little smaller.",
        at: panel("time"),
        does: command({ fault: "damping", severity: 0.3 } as Command),
      },
      {
        title: "Found",
        text: "The bank says damping +30 %. The band below shows the real fault, so you see when the two agree.",
        at: panel("lanes"),
        until: found("b+30"),
      },
      {
        title: "Where it acts",
        text: "In the drawing of the loop a fault is red only where it acts. Click a block for its equations.",
        at: panel("schematic"),
      },
      {
        title: "Heal all",
        text: "All faults are healed. Log lists every command with its author and tick.",
        at: panel("events"),
        does: async () => {
          await send({ heal: "all" } as Command);
          show("events")();
        },
      },
    ],
  },
  {
    title: "Controllers",
    steps: [
      {
        title: "A device that has changed",
        text: "The spring has become 50 % stiffer. Without a controller the plate moves less than the model says.",
        at: panel("time"),
        does: command({ fault: "stiffness", severity: 0.5 } as Command),
      },
      {
        title: "Who drives",
        text: "All controllers run all the time; one of them drives. Here you choose which.",
        at: find("[aria-label=Controller]"),
      },
      {
        title: "MRAC drives",
        text: "Adaptive control has taken over without a jump. It learns the gains that bring the plate back to the model.",
        at: panel("time"),
        does: command({ switch: "mrac" } as Command),
        until: drives("mrac"),
      },
      {
        title: "What it learns",
        text: "Each gain beside its ideal value. When the errors vanish, the gains stop moving.",
        at: panel("adaptation"),
        does: show("adaptation"),
      },
      {
        title: "Back to the open loop",
        text: "A switch is one press, or the key C, and can be taken back by Ctrl Z.",
        at: find("[aria-label=Controller]"),
        does: command({ switch: "open_loop" } as Command),
        until: drives("open_loop"),
      },
    ],
  },
  {
    title: "Diagnosis",
    steps: [
      {
        title: "Six hypotheses",
        text: "Each lane is the probability of one: healthy, a mass, a spring, a damper. They add up to one.",
        at: panel("lanes"),
      },
      {
        title: "Mass +5 %",
        text: "The hatched band is the verdict, the solid one the truth, and the blue mark the delay.",
        at: panel("lanes"),
        does: injectMass,
        until: found("m+5"),
      },
      {
        title: "Why",
        text: "Click a lane, or press W: residual, likelihood, prior and posterior of each filter, in the equation.",
        at: panel("why"),
        does: askLatest,
      },
      {
        title: "The score",
        text: "How often the bank was right, its delays, and the hypotheses it confused.",
        at: panel("scores"),
        does: show("scores"),
      },
      {
        title: "Find one yourself",
        text: "Lesson › Hidden fault hides a fault. You commit an answer, then the page reveals the truth.",
        at: panel("blind"),
        does: show("blind"),
      },
    ],
  },
  {
    title: "Runs and claims",
    steps: [
      {
        title: "From live to headless",
        text: "A bench keeps all that happens on it as a scenario. This menu saves it; run again it gives the same bits.",
        at: find("header [data-menu=more]"),
      },
      {
        title: "Runs and campaigns",
        text: "A run computes one scenario with some seeds, a campaign many variants of it.",
        at: find("main"),
        does: () => setPage("runs"),
      },
      {
        title: "A run of its own",
        text: "The tour has just started the step of 10 V. It is in the list, with its state.",
        at: find("main"),
        does: () => {
          run = startRun();
          return run;
        },
      },
      {
        title: "Claim and measurement",
        text: "The gallery shows each experiment of the text: the claim, the measured figure, and whether they agree.",
        at: find("main"),
        does: () => setPage("gallery"),
      },
      {
        title: "Back to the bench",
        text: "The run of the tour is removed, and your bench continues.",
        at: panel("time"),
        does: () => setPage("bench"),
        until: () => dockNow() !== undefined,
      },
    ],
  },
];
