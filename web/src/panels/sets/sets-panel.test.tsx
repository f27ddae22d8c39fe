import { screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { be, mount, words } from "../../testing/render";
import { SetsPanel } from "./sets-panel";

const { bench } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");
const { sets, difference } = await recordedAnswer("parameter-sets");
const [soft] = sets;
const hard = { ...soft, id: "set-2", name: "<b>hard</b>" };

beforeEach(() => {
  server.on("GET", "/catalog", catalog);
  server.on("GET", "/parameter-sets", { sets: [soft, hard] });
  server.on("GET", "/parameter-sets/:id/difference", difference);
  server.on("POST", "/benches/:id/parameter-sets/:set", { result: { tick: 2001 }, left_out: [] });
});

function mountPanel() {
  const board = connect(bench);
  return { board, ...mount(<SetsPanel />) };
}

it("lists every set by its name, with its scenario", async () => {
  mountPanel();
  expect(await screen.findByText("soft")).toBeVisible();
  expect(screen.getByText("<b>hard</b>")).toBeVisible();
  expect(screen.getAllByRole("listitem")).toHaveLength(2);
  expect(screen.getByText("soft").closest("li")).toHaveTextContent("from first-look");
});

it("asks for no set on a page that was opened by a link to watch", async () => {
  be("watcher");
  mountPanel();
  expect(await screen.findByText("No sets here")).toBeVisible();
  expect(server.asked("GET", "/parameter-sets")).toHaveLength(0);
});

it("keeps the values of now under a name, and lists it", async () => {
  server.on("GET", "/parameter-sets", { sets: [] });
  server.on("POST", "/benches/:id/parameter-sets", soft);
  const { user } = mountPanel();
  expect(await screen.findByText("No set yet")).toBeVisible();
  expect(screen.getByRole("button", { name: "Keep" })).toBeDisabled();
  await user.type(screen.getByLabelText("Keep the values of now as"), " soft ");
  server.on("GET", "/parameter-sets", { sets: [soft] });
  await user.click(screen.getByRole("button", { name: "Keep" }));
  expect(await screen.findByText("soft")).toBeVisible();
  expect(server.asked("POST", "/benches/first-look/parameter-sets")[0].body).toEqual({ name: "soft" });
  expect(screen.getByLabelText("Keep the values of now as")).toHaveValue("");
});

it("says that a name is taken, and leaves it in its field", async () => {
  server.on("POST", "/benches/:id/parameter-sets", new Refusal(409, "there is a set named soft"));
  const { user } = mountPanel();
  await user.type(screen.getByLabelText("Keep the values of now as"), "soft{Enter}");
  expect(await screen.findByText("there is a set named soft")).toBeVisible();
  expect(screen.getByLabelText("Keep the values of now as")).toHaveValue("soft");
});

it("puts a set on the bench in one request, and can take it back", async () => {
  const { board, user } = mountPanel();
  await user.click(await screen.findByRole("button", { name: "Put soft on the bench" }));
  expect(await screen.findByText("soft is on the bench")).toBeVisible();
  expect(server.asked("POST", "/benches/first-look/parameter-sets/set-1")).toHaveLength(1);
  await user.click(screen.getByRole("button", { name: "Undo" }));
  expect(board.commands).toEqual([{ kind: "undo" }]);
});

it("says what of a set is not on the bench, or that the bench has its values already", async () => {
  server.on("POST", "/benches/:id/parameter-sets/:set", { result: { tick: 1 }, left_out: ["a.b"] });
  const { user } = mountPanel();
  await user.click(await screen.findByRole("button", { name: "Put soft on the bench" }));
  expect(await screen.findByText(words("soft is on the bench; 1 value of it are not on this bench"))).toBeVisible();
  server.on("POST", "/benches/:id/parameter-sets/:set", { result: null, left_out: [] });
  await user.click(screen.getByRole("button", { name: "Put soft on the bench" }));
  expect(await screen.findByText("The bench has these values already")).toBeVisible();
});

it("says why a set cannot be put on the bench", async () => {
  server.on("POST", "/benches/:id/parameter-sets/:set", new Refusal(422, "sensor.noise_um is too large"));
  const { user } = mountPanel();
  await user.click(await screen.findByRole("button", { name: "Put soft on the bench" }));
  expect(await screen.findByText("sensor.noise_um is too large")).toBeVisible();
});

it("compares a set with the bench, in names and units, and with another set", async () => {
  const { user } = mountPanel();
  await user.click(await screen.findByRole("button", { name: "Compare soft" }));
  const row = await screen.findByRole("row", { name: /^Noise/ });
  expect(row).toHaveTextContent(/50\snm200\snm$/);
  expect(screen.getByRole("columnheader", { name: "now" })).toBeVisible();
  expect(screen.getByText(new RegExp(`^1\\svalue differs, ${difference.same} are the same$`))).toBeVisible();
  await user.selectOptions(screen.getByLabelText("Compare soft with"), "set-2");
  expect(await screen.findByRole("columnheader", { name: "<b>hard</b>" })).toBeVisible();
  expect(server.asked("GET", "/parameter-sets/set-1/difference").map(({ query }) => query)).toEqual([
    { bench: "first-look" },
    { other: "set-2" },
  ]);
  await user.click(screen.getByRole("button", { name: "End the comparison" }));
  expect(screen.queryByRole("table")).not.toBeInTheDocument();
});

it("asks anew after a change of the bench, and says that nothing differs any more", async () => {
  const { board, user } = mountPanel();
  await user.click(await screen.findByRole("button", { name: "Compare soft" }));
  await screen.findByRole("table");
  server.on("GET", "/parameter-sets/:id/difference", { rows: [], same: 139 });
  board.status({ last_event: bench.last_event + 1 });
  expect(await screen.findByText(/^No difference in 139\svalues\.$/)).toBeVisible();
});

it("gives a set another name on Enter", async () => {
  server.on("PATCH", "/parameter-sets/:id", { ...soft, name: "softer" });
  const { user } = mountPanel();
  await user.click(await screen.findByRole("button", { name: "Rename soft" }));
  const name = screen.getByLabelText("New name of soft");
  await user.clear(name);
  await user.type(name, "softer{Enter}");
  await waitFor(() => expect(server.asked("PATCH", "/parameter-sets/set-1")).toHaveLength(1));
  expect(server.asked("PATCH", "/parameter-sets/set-1")[0].body).toEqual({ name: "softer" });
});

it("deletes a set only after it has asked", async () => {
  server.on("DELETE", "/parameter-sets/:id");
  const confirm = vi.spyOn(window, "confirm").mockReturnValueOnce(false).mockReturnValueOnce(true);
  const { user } = mountPanel();
  const remove = await screen.findByRole("button", { name: "Delete soft" });
  await user.click(remove);
  expect(server.asked("DELETE", "/parameter-sets/set-1")).toHaveLength(0);
  await user.click(remove);
  expect(confirm).toHaveBeenCalledWith("Delete the set soft for good?");
  await waitFor(() => expect(server.asked("DELETE", "/parameter-sets/set-1")).toHaveLength(1));
});

it("lets a student put sets on the bench, and neither keep nor delete any", async () => {
  be("student");
  mountPanel();
  expect(await screen.findByRole("button", { name: "Put soft on the bench" })).toBeVisible();
  expect(screen.queryByRole("button", { name: "Keep" })).not.toBeInTheDocument();
  expect(screen.queryByRole("button", { name: "Delete soft" })).not.toBeInTheDocument();
  expect(screen.queryByRole("button", { name: "Rename soft" })).not.toBeInTheDocument();
});
