import { act, screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { queryClient } from "../api/queries";
import type { ViewName } from "../bench/panel-views";
import { server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { be, mount } from "../testing/render";
import { PanelBody } from "./panel-body";
import { VIEW } from "./panels";

const { bench: hidden, asked } = await recordedAnswer("blind");
const { bench: open } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");
const sheets = await recordedAnswer("sheets");
const { games, plays } = await recordedAnswer("games");
const identification = await recordedAnswer("identification");
const axes = (view: string) => (VIEW[view as ViewName].only === "axes" ? ["x", "y"] : []);
const NAMES = Object.keys(VIEW) as ViewName[];

beforeEach(() => {
  server.on("GET", "/catalog", catalog);
  server.on("GET", "/benches/:id/blind", asked);
  server.on("GET", "/sheets", { ...sheets, current: null }); // a sheet names faults in its tasks
  server.on("GET", "/games", { games });
  server.on("GET", "/games/:id", ({ params }: { params: Record<string, string> }) => plays[params.id].before);
  server.on("GET", "/classes", { classes: [] });
  server.on("GET", "/votes", { votes: [] });
  server.on("GET", "/benches/:id/printed", { marks: [] });
  server.on("POST", "/benches/:id/identification", identification);
});

const show = (view: ViewName) => mount(<PanelBody view={view} params={{}} setParams={() => undefined} />);

/** The data of the page about a bench with an added mass, and the question of the server. */
const knowing = { ...hidden, faults: open.faults, diagnosers: open.diagnosers, pending: open.pending };

it.each(NAMES)("shows nothing in the view %s that tells the hidden fault", async (view) => {
  expect(open.faults.map(({ name }) => name)).toEqual(["added_mass"]);
  connect({ ...knowing, axes: axes(view) } as typeof hidden);
  const { user } = show(view);
  const clean = () => expect(document.body.innerHTML).not.toMatch(/added.mass|fault acts|the truth is|severity/i);
  await waitFor(() => expect(queryClient.isFetching()).toBe(0));
  clean();
  for (const tool of screen.queryAllByRole("button", { name: /^(Frequency response|Spectrum|Cursors)$/ })) {
    if (tool.getAttribute("aria-pressed") === "false") await user.click(tool);
    clean();
  }
});

it("says in one line that a view is hidden, and opens a tool in its place", async () => {
  connect(hidden);
  const { user } = show("card");
  const hiddenView = screen.getByRole("region", { name: "Block, hidden" });
  expect(hiddenView).toHaveTextContent(/^Block: hidden until you answer. Measure instead:/);
  expect(within(hiddenView).queryByRole("region")).not.toBeInTheDocument();
  await user.click(screen.getByRole("button", { name: "Spectrum" }));
  expect(screen.getByRole("region", { name: "Spectrum" })).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Cursors" }));
  expect(screen.queryByRole("region", { name: "Spectrum" })).not.toBeInTheDocument();
  expect(screen.getByRole("region", { name: "Scope: sensor.displacement, drive.voltage" })).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Tools" }));
  expect(await screen.findByRole("menuitem", { name: "Without cursors and figures" })).toBeVisible();
  await user.keyboard("{Escape}");
  await user.click(screen.getByRole("button", { name: "Cursors" }));
  expect(within(hiddenView).queryByRole("region")).not.toBeInTheDocument();
});

it("leaves the traces between cursors 140 px beside the letters of the axes; the figures scroll", () => {
  connect(hidden);
  show("view3d");
  const traces = () => screen.getByRole("group", { name: /^Plot/ }).parentElement?.style.flex;
  expect(screen.getByRole("region", { name: "3D, hidden" })).toHaveTextContent("Measure instead:");
  expect(traces()).toMatch(/^1 0 calc\(140px \+/);
});

it("sweeps the device in place of the lanes, and has the lanes back after the answer", async () => {
  const board = connect(hidden);
  const { user } = show("lanes");
  await user.click(screen.getByRole("button", { name: "Sweep the device" }));
  expect(server.asked("POST", `/benches/${hidden.id}/identification`)).toHaveLength(1);
  expect(await screen.findByRole("row", { name: /^Resonance f₀/ })).toBeVisible();
  act(() => board.hello({ ...open, id: hidden.id }));
  expect(screen.queryByRole("region", { name: /, hidden$/ })).not.toBeInTheDocument();
});

it("has no sweep in a game, on a gyroscope, or for somebody who only watches", () => {
  const tools = () => within(screen.getByRole("region", { name: "Faults, hidden" })).getAllByRole("button");
  const names = () =>
    tools()
      .map((button) => button.textContent)
      .slice(0, 3);
  const question = hidden.blind as NonNullable<typeof hidden.blind>;
  const board = connect({ ...hidden, blind: { ...question, game: { game: "g", seed: 1 } } });
  show("faults");
  expect(screen.getByText(/hidden until the game is over/)).toBeVisible();
  expect(names()).not.toContain("Frequency response");
  board.hello({ ...hidden, axes: ["x", "y"] });
  expect(names()).not.toContain("Frequency response");
  board.hello(hidden);
  expect(names()).toEqual(["Frequency response", "Spectrum", "Cursors"]);
  act(() => be("watcher"));
  expect(names()).not.toContain("Frequency response");
});

it("shows the lanes of a bank that may be looked at", () => {
  const question = hidden.blind as NonNullable<typeof hidden.blind>;
  connect({ ...knowing, blind: { ...question, shows: ["kalman"] } });
  show("lanes");
  expect(screen.queryByRole("region", { name: "Lanes, hidden" })).not.toBeInTheDocument();
});
