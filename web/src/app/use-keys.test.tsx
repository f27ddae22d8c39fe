import { NativeSelect, Radio, Select } from "@mantine/core";
import { screen } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { server } from "../testing/fake-server";
import { connect, type FakeTransport } from "../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { be, mount } from "../testing/render";
import { ControllerSelect } from "./header/controller-select";
import { useKeys } from "./use-keys";

const { bench } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");

beforeEach(() => server.on("GET", "/catalog", catalog));

function Page() {
  useKeys();
  return (
    <>
      <ControllerSelect />
      <input aria-label="Search" />
      <NativeSelect aria-label="Native" data={["one", "two"]} />
      <Radio.Group aria-label="Plant" defaultValue="linear">
        <Radio value="linear" label="Linear" />
        <Radio value="planar" label="Planar" />
      </Radio.Group>
      <Select aria-label="Other" data={["one", "two"]} />
      <button type="button">A button</button>
    </>
  );
}

function mountPage() {
  const board = connect(bench);
  return { board, ...mount(<Page />) };
}

/** Space runs the bench, so the page has its keys. */
const hasKeys = (board: FakeTransport) => expect(board.commands.at(-1)).toEqual({ kind: "start" });

it("has its keys after Escape from a list", async () => {
  const { board, user } = mountPage();
  const list = screen.getByRole("combobox", { name: "Controller" });
  await user.click(list);
  await screen.findByText("PID");
  expect(list).toHaveAttribute("aria-expanded", "true");
  await user.keyboard("{Escape}");
  expect(list).toHaveAttribute("aria-expanded", "false");
  await user.keyboard(" ");
  hasKeys(board);
});

it("leaves a field its letters, and has its keys after Escape from the field", async () => {
  const { board, user } = mountPage();
  await user.click(screen.getByRole("textbox", { name: "Search" }));
  await user.keyboard("a.");
  expect(screen.getByRole("textbox", { name: "Search" })).toHaveValue("a.");
  expect(board.commands).toEqual([]);
  await user.keyboard("{Escape} ");
  hasKeys(board);
});

it("has its keys after a choice from the list of controllers", async () => {
  const { board, user } = mountPage();
  await user.click(screen.getByRole("combobox", { name: "Controller" }));
  await user.click(await screen.findByText("PID"));
  expect(board.commands).toEqual([{ switch: "pid", cold: false }]);
  await user.keyboard(" ");
  hasKeys(board);
});

it("has its keys after a choice with the pointer, and not after a choice with the keys", async () => {
  const { board, user } = mountPage();
  await user.click(screen.getByRole("radio", { name: "Planar" }));
  await user.keyboard(" ");
  hasKeys(board);
  await user.click(screen.getByRole("combobox", { name: "Native" }));
  await user.selectOptions(screen.getByRole("combobox", { name: "Native" }), "two");
  await user.keyboard(".");
  expect(board.commands.at(-1)).toEqual({ kind: "step", ticks: 1 });
  screen.getByRole("radio", { name: "Planar" }).focus();
  await user.keyboard("{ArrowUp}");
  expect(screen.getByRole("radio", { name: "Linear" })).toHaveFocus();
});

it("leaves Space to a button that has the focus", async () => {
  const { board, user } = mountPage();
  screen.getByRole("button", { name: "A button" }).focus();
  await user.keyboard(" ");
  expect(board.commands).toEqual([]);
});

it.each([
  [".", { kind: "step", ticks: 1 }],
  [",", { kind: "step_period" }],
  ["]", { kind: "time_scale", value: 2 * Number(bench.time_scale) }],
  ["[", { kind: "time_scale", value: Number(bench.time_scale) / 2 }],
  ["R", { kind: "reset" }],
  ["h", { heal: "all" }],
])("%s sends its command", async (key, command) => {
  const { board, user } = mountPage();
  await user.keyboard(key.replace("[", "[["));
  expect(board.commands).toEqual([command]);
});

it("acts on Ctrl Z and on nothing with Alt", async () => {
  const { board, user } = mountPage();
  await user.keyboard("{Control>}z{/Control}");
  expect(board.commands).toEqual([{ kind: "undo" }]);
  await user.keyboard("{Alt>}h{/Alt}{Control>}h{/Control}");
  expect(board.commands).toHaveLength(1);
});

it("sends nothing for a watcher", async () => {
  be("watcher");
  const { board, user } = mountPage();
  await user.keyboard(" .,]Rh");
  expect(board.commands).toEqual([]);
});
