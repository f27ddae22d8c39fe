import { act, screen } from "@testing-library/react";
import type { IDockviewPanel } from "dockview-react";
import { expect, it } from "vitest";
import type { PanelName } from "../bench/panel-views";
import { connect } from "../testing/fake-transport";
import { recordedBench } from "../testing/recorded";
import { mount } from "../testing/render";
import { ViewChoice } from "./view-choice";

const flat = (await recordedBench("first-look")).bench;
const gyroscope = (await recordedBench("gyroscope")).bench;
const WIDE = 800;
const NARROW = 80;

/** A docked panel with its kind and its parameters alone. */
function docked(kind: PanelName, params: object = {}) {
  const heard = new Set<() => void>();
  const panel = {
    view: { contentComponent: kind },
    params,
    api: {
      updateParameters: (next: object) => {
        panel.params = next;
        for (const tell of heard) tell();
      },
      onDidParametersChange: (tell: () => void) => {
        heard.add(tell);
        return { dispose: () => heard.delete(tell) };
      },
    },
  };
  return { panel: panel as unknown as IDockviewPanel, heard };
}

function mountChoice(kind: PanelName, { bench = flat, room = WIDE, params = {} } = {}) {
  connect(bench);
  const { panel, heard } = docked(kind, params);
  const { user, unmount } = mount(<ViewChoice panel={panel} room={room} />);
  return { panel, heard, user, unmount };
}
const names = () => screen.getAllByRole("button").map((button) => button.textContent);

it("has the views of a panel in a row, the shown one pressed", () => {
  mountChoice("diagnosis", { params: { view: "labs" } });
  expect(screen.getByRole("group", { name: "Views of Diagnosis" })).toBeVisible();
  expect(names()).toEqual(["Lanes", "Hypotheses", "Noise and memory", "Scoreboard"]);
  expect(screen.getByRole("button", { pressed: true })).toHaveTextContent("Noise and memory");
});

it("has the first view of a panel that names none, or none of its own", () => {
  mountChoice("lesson", { params: { view: "lanes" } });
  expect(screen.getByRole("button", { pressed: true })).toHaveTextContent("Lab sheet");
});

it("has the views that suit the bench alone, and no choice of one", () => {
  const { unmount } = mountChoice("diagnosis", { bench: gyroscope });
  expect(names()).toEqual(["Lanes", "Scoreboard"]);
  unmount();
  mountChoice("why");
  expect(screen.queryByRole("button")).not.toBeInTheDocument();
});

it("turns the panel, keeps the rest of its parameters, and follows when others turn it", async () => {
  const scope = { signals: ["plant.displacement"] };
  const { panel, user } = mountChoice("scope", { params: { scope } });
  await user.click(screen.getByRole("button", { name: "Spectrum" }));
  expect(panel.params).toEqual({ scope, view: "spectrum" });
  expect(screen.getByRole("button", { pressed: true })).toHaveTextContent("Spectrum");
  act(() => panel.api.updateParameters({ scope, view: "phase" }));
  expect(screen.getByRole("button", { pressed: true })).toHaveTextContent("Phase plane");
});

it("has the views in a menu where the bar of tabs has no room for the row", async () => {
  const { panel, user } = mountChoice("diagnosis", { room: NARROW });
  await user.click(screen.getByRole("button", { name: "Views of Diagnosis: Lanes" }));
  const items = await screen.findAllByRole("menuitem");
  expect(items.map((item) => item.textContent)).toEqual(["Lanes", "Hypotheses", "Noise and memory", "Scoreboard"]);
  expect(items.map((item) => item.getAttribute("aria-current"))).toEqual(["true", "false", "false", "false"]);
  await user.click(items[3]);
  expect(panel.params).toEqual({ view: "scores" });
  expect(screen.getByRole("button", { name: "Views of Diagnosis: Scoreboard" })).toBeVisible();
});

it("stops to follow a panel once it is gone", () => {
  const { heard, unmount } = mountChoice("device");
  expect(heard.size).toBe(1);
  unmount();
  expect(heard.size).toBe(0);
});
