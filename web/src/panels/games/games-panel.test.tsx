import { screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { chooseGame } from "../../bench/game";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { GamesPanel } from "./games-panel";

const { games, plays } = await recordedAnswer("games");
const { bench } = await recordedBench("first-look");
const [filter, fool] = games.map(({ id }) => id);
const game = (id: string) => ({ ...bench, blind: { id: "q", game: { game: id, seed: 1 }, answers: [] } }) as never;

beforeEach(() => {
  server.on("GET", "/games", { games });
  server.on("GET", "/games/:id", ({ params }: { params: { id: string } }) => plays[params.id].before);
  server.on("GET", "/classes", { classes: [] });
  server.on("POST", "/games/:id/begin", ({ params }: { params: { id: string } }) => plays[params.id].after);
  server.on("POST", "/games/:id/attempts", ({ params }: { params: { id: string } }) => plays[params.id].after);
  chooseGame(filter, 1);
});

async function mountGame(id = filter, of = bench) {
  const board = connect(of);
  chooseGame(id, 1);
  const shown = mount(<GamesPanel />);
  await screen.findByRole("button", { name: "Hand in" });
  return { board, ...shown };
}

it("plays a game on a bench of its own", async () => {
  const { user } = await mountGame();
  expect(screen.getByText(games[0].task)).toBeVisible();
  expect(screen.getByText(/^5\sattempts left$/)).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Play on a new bench" }));
  expect(server.asked("POST", `/games/${filter}/begin`)[0].body).toEqual({ seed: 1, hand_in: {} });
  await waitFor(() => expect(window.location.search).toContain(`bench=${plays[filter].after.bench}`));
});

it("hands in what is set, and says what came of it", async () => {
  const { user } = await mountGame(fool);
  await user.selectOptions(screen.getByRole("combobox", { name: "Fault" }), "Sensor bias");
  const severity = screen.getByRole("textbox", { name: /^Severity/ });
  await user.clear(severity);
  await user.type(severity, "0.5{Enter}");
  await user.click(screen.getByRole("button", { name: "Hand in" }));
  expect(server.asked("POST", `/games/${fool}/attempts`)[0].body).toEqual({
    seed: 1,
    hand_in: { fault: "sensor_bias", severity: 0.5 },
  });
  expect(await screen.findByText("No attempt left at this seed.")).toBeVisible();
  expect(screen.getByText(/^The bank misses drive gain/)).toBeVisible();
  expect(screen.getByRole("button", { name: "Hand in" })).toBeDisabled();
  await user.click(screen.getByRole("button", { name: "Next seed" }));
  await waitFor(() => expect(server.asked("GET", `/games/${fool}`).at(-1)?.query).toEqual({ seed: "2" }));
});

it("hands in the fault that is shown when none was chosen", async () => {
  const { user } = await mountGame(fool);
  await user.click(screen.getByRole("button", { name: "Hand in" }));
  expect(server.asked("POST", `/games/${fool}/attempts`)[0].body).toEqual({
    seed: 1,
    hand_in: { fault: "drive_gain" },
  });
});

it("tries a fault on the bench while the game is played there, in percent where it is a share", async () => {
  const { board, user } = await mountGame(fool, game(fool));
  const severity = screen.getByRole("textbox", { name: "Severity, %" });
  await user.clear(severity);
  await user.type(severity, "20{Enter}");
  await user.click(screen.getByRole("button", { name: "Try it on the bench" }));
  expect(board.commands).toEqual([{ fault: "drive_gain", severity: 0.2 }]);
});

it("turns what the bank assumes on the bench at once, and a sixth hypothesis not", async () => {
  const { board, user } = await mountGame(filter, game(filter));
  const set = async (name: RegExp, value: string) => {
    const field = screen.getByRole("textbox", { name });
    await user.clear(field);
    await user.type(field, `${value}{Enter}`);
  };
  await set(/^assumed noise scale/i, "2");
  await set(/^mass/i, "1.2");
  expect(board.commands).toEqual([{ set: { "diagnosers.kalman.assumed_noise_scale": 2 } }]);
  await user.click(screen.getByRole("button", { name: "Hand in" }));
  expect(server.asked("POST", `/games/${filter}/attempts`)[0].body).toEqual({
    seed: 1,
    hand_in: { assumed_noise_scale: 2, mass: 1.2 },
  });
});

it("shows what is hidden once that is confirmed", async () => {
  vi.spyOn(window, "confirm").mockReturnValueOnce(false).mockReturnValue(true);
  server.on("GET", "/games/:id", plays[filter].after);
  server.on("POST", "/games/:id/reveal", {
    ...plays[filter].after,
    left: 0,
    hidden: [{ name: "Noise", said: "0.6 um" }],
  });
  const { user } = await mountGame();
  await user.click(screen.getByRole("button", { name: "Show the solution" }));
  expect(server.asked("POST", `/games/${filter}/reveal`)).toEqual([]);
  await user.click(screen.getByRole("button", { name: "Show the solution" }));
  expect(await screen.findByText("0.6 um")).toBeVisible();
  expect(server.asked("POST", `/games/${filter}/reveal`)[0].body).toEqual({ seed: 1 });
});

it("has a table of the attempts, with places and points, the last included", async () => {
  const [mine] = plays[filter].after.table;
  const other = { ...mine, id: "b", name: "<i>Ben</i>", mine: false, points: 3.25, handed_in: null };
  server.on("GET", "/games/:id", { ...plays[filter].after, table: [mine, other] });
  await mountGame();
  const rows = within(screen.getByRole("table")).getAllByRole("row").slice(1);
  expect(
    rows.map((row) =>
      within(row)
        .getAllByRole("cell")
        .slice(0, 4)
        .map((cell) => cell.textContent),
    ),
  ).toEqual([
    ["1", "teacher", "18.3", "as by default"],
    ["2", "<i>Ben</i>", "3.3", "–"],
  ]);
});

it("says why nothing was judged", async () => {
  server.on("POST", "/games/:id/attempts", new Refusal(409, "The bench has not come so far."));
  const { user } = await mountGame();
  await user.click(screen.getByRole("button", { name: "Hand in" }));
  expect(await screen.findByText("The bench has not come so far.")).toBeVisible();
});
