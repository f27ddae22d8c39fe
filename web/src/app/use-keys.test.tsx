import { MultiSelect, NativeSelect, Select, TextInput } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { screen } from "@testing-library/react";
import { expect, it, vi } from "vitest";
import { useAnnouncements } from "../bench/announce";
import { useView } from "../bench/view-store";
import { server } from "../testing/fake-server";
import { connect, type FakeTransport } from "../testing/fake-transport";
import { recordedBench } from "../testing/recorded";
import { be, mount } from "../testing/render";
import * as files from "../ui/save-file";
import { setPresent } from "./present";
import { useKeys } from "./use-keys";

const { bench } = await recordedBench("first-look");

function Page() {
  useKeys();
  return (
    <>
      <TextInput label="Text" />
      <Select label="List" data={["one", "two"]} searchable />
      <MultiSelect label="Several" data={["one", "two"]} />
      <NativeSelect label="Native" data={["one", "two"]} />
      <input type="checkbox" aria-label="Box" />
      <button type="button">Press</button>
      <div role="tab" tabIndex={0}>
        Tab
      </div>
    </>
  );
}

function mountKeys(): { board: FakeTransport; user: ReturnType<typeof mount>["user"] } {
  const board = connect(bench);
  return { board, ...mount(<Page />) };
}

const STEP = { kind: "step", ticks: 1 };

it.each([
  [" ", { kind: "start" }],
  [".", STEP],
  [",", { kind: "step_period" }],
  ["R", { kind: "reset" }],
  [">", { kind: "fast_forward" }],
  ["h", { heal: "all" }],
])("the key %s sends its command", async (key, command) => {
  const { board, user } = mountKeys();
  await user.keyboard(key);
  expect(board.commands).toEqual([command]);
});

it("] doubles the pace and [ halves it", async () => {
  const { board, user } = mountKeys();
  board.status({ time_scale: 0.002 });
  await user.keyboard("]");
  await user.keyboard("[[");
  expect(board.commands).toEqual([
    { kind: "time_scale", value: 0.004 },
    { kind: "time_scale", value: 0.001 },
  ]);
});

it("the space bar pauses a bench that runs", async () => {
  const { board, user } = mountKeys();
  board.status({ state: "running" });
  await user.keyboard(" ");
  expect(board.commands).toEqual([{ kind: "pause" }]);
});

it.each([
  "Text",
  "List",
  "Several",
  "Native",
])("a key typed in the field %s is no command, until Escape leaves it", async (label) => {
  const { board, user } = mountKeys();
  const field = screen.getByRole(label === "Text" ? "textbox" : "combobox", { name: label });
  field.focus();
  await user.keyboard(".");
  expect(board.commands).toEqual([]);
  await user.keyboard("{Escape}");
  expect(field).not.toHaveFocus();
  await user.keyboard(".");
  expect(board.commands).toEqual([STEP]);
});

it("a list that was opened gives the keys back after Escape", async () => {
  const { board, user } = mountKeys();
  await user.click(screen.getByRole("combobox", { name: "List" }));
  expect(screen.getByRole("listbox")).toBeVisible();
  await user.keyboard("{Escape}");
  await user.keyboard(".");
  expect(board.commands).toEqual([STEP]);
});

it("a choice by the pointer gives the keys back, a choice by keys keeps them", async () => {
  const { board, user } = mountKeys();
  const box = screen.getByRole("checkbox", { name: "Box" });
  await user.click(box);
  expect(box).not.toHaveFocus();
  box.focus();
  await user.keyboard(" ");
  expect(box).toHaveFocus();
  expect(box).not.toBeChecked();
  expect(board.commands).toEqual([]);
});

it.each(["button", "tab"])("the space bar on a %s is not the page's", async (role) => {
  const { board, user } = mountKeys();
  screen.getByRole(role).focus();
  await user.keyboard(" ");
  expect(board.commands).toEqual([]);
  await user.keyboard(".");
  expect(board.commands).toEqual([STEP]);
});

it("a key with Alt, or with a Control that it does not want, does nothing", async () => {
  const { board, user } = mountKeys();
  await user.keyboard("{Alt>}.{/Alt}{Control>}.{/Control}h");
  expect(board.commands).toEqual([{ heal: "all" }]);
});

it("Control and Z undo the last change of the bench", async () => {
  const { board, user } = mountKeys();
  board.status({ undo: { seq: 3, text: "added mass" } as never });
  await user.keyboard("{Control>}z{/Control}");
  expect(board.commands).toEqual([{ kind: "undo" }]);
});

it("no key of a watcher changes the bench", async () => {
  be("watcher");
  const { board, user } = mountKeys();
  await user.keyboard(" .,][[Rh>cv{Control>}z{/Control}{Control>}y{/Control}");
  expect(board.commands).toEqual([]);
  expect(useView.getState().dialog).toBe("none");
});

it("X saves the run as a scenario, and S makes a slide only after a change", async () => {
  const text = "#:schema ./scenario.schema.json\n# 2000 ticks, digest 0123456789abcdef\nschema = 1\n";
  server.on("GET", "/benches/:id/scenario", text);
  const told = vi.spyOn(notifications, "show");
  const saved = vi.spyOn(files, "saveFile").mockReturnValue();
  const { user } = mountKeys();
  await user.keyboard("s");
  expect(server.requests).toEqual([]);
  expect(useAnnouncements.getState().polite).toBe("There is nothing to compare: nothing has changed.");
  await user.keyboard("x");
  await vi.waitFor(() => expect(saved).toHaveBeenCalledWith("first-look-2000.toml", expect.any(Blob)));
  expect(told.mock.lastCall?.[0].message).toContain("digest 0123456789ab…");
});

it("a student has no key to share, fork or keep", async () => {
  be("student");
  const { user } = mountKeys();
  await user.keyboard("SFKfk");
  expect(useView.getState().dialog).toBe("none");
});

it("Escape ends the presentation, but not from within a field", async () => {
  document.documentElement.requestFullscreen ??= vi.fn(() => Promise.resolve());
  const { user } = mountKeys();
  await user.keyboard("p");
  expect(useView.getState().present).toBe(true);
  expect(window.location.search).toContain("present=1");
  screen.getByRole("textbox", { name: "Text" }).focus();
  await user.keyboard("{Escape}");
  expect(useView.getState().present).toBe(true);
  await user.keyboard("{Escape}");
  expect(useView.getState().present).toBe(false);
  expect(window.location.search).not.toContain("present");
});

it("a presentation is of the bench, whatever page was shown", () => {
  useView.setState({ page: "runs" });
  window.history.replaceState(null, "", "/?page=runs");
  setPresent(true);
  expect(useView.getState().page).toBe("bench");
  expect(window.location.search).toBe("?present=1");
});

it.each([
  ["?", "keys"],
  ["n", "bench"],
  ["S", "share"],
])("the key %s opens its sheet", async (key, dialog) => {
  const { user } = mountKeys();
  await user.keyboard(key);
  expect(useView.getState().dialog).toBe(dialog);
});

it.each([
  ["e", "gallery"],
  ["u", "runs"],
  ["m", "class"],
  ["g", "designer"],
  ["t", "theory"],
])("the key %s goes to its page, and back", async (key, page) => {
  const { user } = mountKeys();
  await user.keyboard(key);
  expect(useView.getState().page).toBe(page);
  await user.keyboard(key);
  expect(useView.getState().page).toBe("bench");
});
