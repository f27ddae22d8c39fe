import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { Refusal, server } from "../testing/fake-server";
import { recordedAnswer } from "../testing/recorded";
import { mount } from "../testing/render";
import { Joining } from "./joining";
import { OpenClass } from "./open-class";

const { class: group } = await recordedAnswer("class");
const { scenarios } = await recordedAnswer("scenarios");
const library = scenarios.filter(({ id }) => ["first-look", "ch5-seven-step"].includes(id));
beforeEach(() => server.on("GET", "/scenarios", { scenarios: library }));

async function mountForm() {
  const onOpened = vi.fn();
  const shown = mount(<OpenClass onOpened={onOpened} />);
  await screen.findByRole("option", { name: /^First look/ });
  return { ...shown, onOpened, open: screen.getByRole("button", { name: "Open the class" }) };
}

it("opens a class with its name, its scenario and its times", async () => {
  server.on("POST", "/classes", group);
  const { user, onOpened, open } = await mountForm();
  expect(open).toBeDisabled();
  await user.type(screen.getByLabelText(/^Name of the class/), " Tuesday ");
  await user.selectOptions(screen.getByLabelText("Benches begin with"), "ch5-seven-step");
  await user.clear(screen.getByLabelText("Duration"));
  await user.type(screen.getByLabelText("Duration"), "3");
  await user.click(open);
  expect(server.asked("POST", "/classes")[0].body).toEqual({
    name: "Tuesday",
    bench: { scenario: "ch5-seven-step", paused: false, quiet_lead: true },
    hours: 3,
    minutes: 120,
  });
  expect(onOpened).toHaveBeenCalledWith(group);
});

it("does not open one that lasts no time or too long, and says so at its field", async () => {
  const { user, open } = await mountForm();
  await user.type(screen.getByLabelText(/^Name of the class/), "Tuesday");
  const hours = screen.getByLabelText("Duration");
  await user.clear(hours);
  await user.type(hours, "400");
  expect(hours).toBeInvalid();
  expect(screen.getByText("More than 0, at most 336")).toBeVisible();
  expect(open).toBeDisabled();
});

it("says why the server opens none", async () => {
  server.on("POST", "/classes", new Refusal(409, "This server has its most classes."));
  const { user, onOpened, open } = await mountForm();
  await user.type(screen.getByLabelText(/^Name of the class/), "Tuesday");
  await user.click(open);
  expect(await screen.findByText("This server has its most classes.")).toBeVisible();
  expect(onOpened).not.toHaveBeenCalled();
});

it("shows the code with its picture, and the code alone on the wall until Escape", async () => {
  const { user } = mount(<Joining group={group} isBrief={false} onChanged={() => undefined} />);
  expect(screen.getByRole("status", { name: "Join code" })).toHaveTextContent("CODE");
  expect(screen.getByRole("img", { name: /^QR code of .*\/join\?code=CODE/ })).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Show on the wall" }));
  const wall = screen.getByRole("dialog", { name: "Sensors" });
  expect(wall).toHaveTextContent("CODE");
  expect(within(wall).getByText(/\/join$/)).toBeVisible(); // the address is typed without the code
  await user.keyboard("{Escape}");
  expect(screen.queryByRole("dialog")).not.toBeInTheDocument();
});

it("makes a new code for a while, closes joining, and says that it is closed", async () => {
  server.on("POST", "/classes/class-1/code", group);
  server.on("DELETE", "/classes/class-1/code", group);
  const changed = vi.fn();
  const { user, unmount } = mount(<Joining group={group} isBrief onChanged={changed} />);
  expect(screen.queryByRole("img")).not.toBeInTheDocument();
  await user.click(screen.getByRole("button", { name: "New code" }));
  await user.click(await screen.findByRole("menuitem", { name: "for 1 hour" }));
  expect(server.asked("POST", "/classes/class-1/code")[0].body).toEqual({ minutes: 60 });
  await user.click(screen.getByRole("button", { name: "Close joining" }));
  expect(server.asked("DELETE", "/classes/class-1/code")).toHaveLength(1);
  await vi.waitFor(() => expect(changed).toHaveBeenCalledTimes(2));
  unmount();
  mount(<Joining group={{ ...group, code: "", path: "" } as never} isBrief onChanged={changed} />);
  expect(screen.getByText(/^Joining is closed/)).toBeVisible();
  expect(screen.queryByRole("button", { name: "Close joining" })).not.toBeInTheDocument();
});
