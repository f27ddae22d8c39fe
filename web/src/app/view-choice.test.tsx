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

function mountChoice(kind: PanelName, { bench = flat, params = {} } = {}) {
  connect(bench);
  const { panel, heard } = docked(kind, params);
  const { user, unmount } = mount(<ViewChoice panel={panel} />);
  return { panel, heard, user, unmount };
}
/** The names of the views, from the open menu. */
const names = async (user: ReturnType<typeof mount>["user"]) => {
  await user.click(screen.getByRole("button"));
  return (await screen.findAllByRole("menuitem")).map((item) => item.textContent);
};

it("has the views of a panel in a menu, the shown view on its button", async () => {
  const { user } = mountChoice("diagnosis", { params: { view: "labs" } });
  expect(screen.getByRole("button", { name: "Views of Diagnosis: Noise and memory" })).toBeVisible();
  expect(await names(user)).toEqual(["Lanes", "Hypotheses", "Noise and memory", "Scoreboard"]);
  const marks = screen.getAllByRole("menuitem").map((item) => item.getAttribute("aria-current"));
  expect(marks).toEqual(["false", "false", "true", "false"]);
});

it("has the first view of a panel that names none, or none of its own", () => {
  mountChoice("lesson", { params: { view: "lanes" } });
  expect(screen.getByRole("button", { name: "Views of Lesson: Lab sheet" })).toBeVisible();
});

it("has the views that suit the bench alone, and no choice of one", async () => {
  const { unmount, user } = mountChoice("diagnosis", { bench: gyroscope });
  expect(await names(user)).toEqual(["Lanes", "Scoreboard"]);
  unmount();
  mountChoice("why");
  expect(screen.queryByRole("button")).not.toBeInTheDocument();
});

it("turns the panel, keeps the rest of its parameters, and follows when others turn it", async () => {
  const scope = { signals: ["plant.displacement"] };
  const { panel, user } = mountChoice("scope", { params: { scope } });
  await user.click(screen.getByRole("button", { name: "Views of Scope: Time" }));
  await user.click(await screen.findByRole("menuitem", { name: "Spectrum" }));
  expect(panel.params).toEqual({ scope, view: "spectrum" });
  expect(screen.getByRole("button", { name: "Views of Scope: Spectrum" })).toBeVisible();
  act(() => panel.api.updateParameters({ scope, view: "phase" }));
  expect(screen.getByRole("button", { name: "Views of Scope: Phase plane" })).toBeVisible();
});

it("stops to follow a panel once it is gone", () => {
  const { heard, unmount } = mountChoice("device");
  expect(heard.size).toBe(1);
  unmount();
  expect(heard.size).toBe(0);
});
