import { act, screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { useMe } from "../api/me";
import type { Company } from "../api/types";
import { useView } from "../bench/view-store";
import { Refusal, server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { be, mount } from "../testing/render";
import { ClassLines } from "./class-lines";
import { CompanyMenu } from "./header/company";
import { Visitor } from "./header/visitor";

const { bench } = await recordedBench("first-look");
const { class: group } = await recordedAnswer("class");
const ADA = { id: "ada", name: "Ada <b>" };
const TEACHER = { id: "teacher", name: "teacher" };
const company: Company = {
  is_leased: true,
  driver: ADA,
  drivers: [TEACHER, ADA],
  asking: [],
  lent_by: "",
  watching: ["Ben"],
  more_watching: 2,
  links: 1,
};
const at = (rest: Partial<Company> = {}) => connect({ ...bench, company: { ...company, ...rest } });
const turns = () => server.asked("POST", `/benches/${bench.id}/driving`).map(({ body }) => body);

beforeEach(() => {
  server.on("POST", "/benches/:id/driving", { company });
  server.on("GET", "/classes", { classes: [] });
});

it("says who drives and who looks on", async () => {
  be("teacher", { id: "teacher" });
  at();
  const { user } = mount(<CompanyMenu />);
  const button = screen.getByTitle("Who is here");
  expect(button).toHaveTextContent("Ada <b> drives");
  await user.click(button);
  expect(await screen.findByText("Ben, 2 more")).toBeVisible();
  expect(screen.getByText(/^1\spage$/)).toBeVisible();
});

it.each([
  ["teacher", {}, /^Ask to drive/, { do: "ask", to: "" }],
  ["teacher", {}, "Take the bench", { do: "take", to: "" }],
  ["teacher", { driver: TEACHER }, "Hand over to Ada <b>", { do: "hand_over", to: "ada" }],
  ["teacher", { driver: TEACHER }, /^Drive no longer/, { do: "leave", to: "" }],
  ["teacher", { driver: null }, "Drive this bench", { do: "ask", to: "" }],
  ["student", { lent_by: "me" }, "Take the bench back", { do: "take", to: "" }],
] as const)("a %s can turn the bench over (%#)", async (role, rest, item, turn) => {
  be(role, { id: role === "teacher" ? "teacher" : "me" });
  at(rest as Partial<Company>);
  const { user } = mount(<CompanyMenu />);
  await user.click(screen.getByTitle("Who is here"));
  await user.click(await screen.findByRole("menuitem", { name: item }));
  expect(turns()).toEqual([turn]);
});

it("lets no other student take the bench, and none ask twice", async () => {
  be("student", { id: "me" });
  at({ asking: [{ id: "me", name: "Me" }] });
  const { user } = mount(<CompanyMenu />);
  await user.click(screen.getByTitle("Who is here"));
  expect(await screen.findByRole("menuitem", { name: /^You have asked/ })).toBeDisabled();
  expect(screen.queryByRole("menuitem", { name: /^Take/ })).not.toBeInTheDocument();
});

it("asks the driver whether to hand over, and nobody else", async () => {
  be("student", { id: "ada" });
  at({ asking: [TEACHER] });
  const { user, unmount } = mount(<ClassLines />);
  expect(screen.getByText("The teacher asks to drive this bench.")).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Go on driving" }));
  await user.click(screen.getByRole("button", { name: "Hand over" }));
  expect(turns()).toEqual([
    { do: "refuse", to: "teacher" },
    { do: "hand_over", to: "teacher" },
  ]);
  unmount();
  be("student", { id: "ben" });
  mount(<ClassLines />);
  expect(screen.queryByText(/asks to drive/)).not.toBeInTheDocument();
});

it("tells a student of a bench that was handed over, and gives it back", async () => {
  be("student", { id: "ada", bench: "own", lent: bench.id });
  at();
  act(() => useMe.setState({ at: bench.id }));
  server.on("GET", "/me", { ...useMe.getState().me, lent: null });
  server.on("GET", "/benches/own", { ...bench, id: "own" });
  server.on("GET", "/sheets", { sheets: [], current: null });
  const { user } = mount(<ClassLines />);
  expect(screen.getByText("Your teacher has handed you this bench.")).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Give it back" }));
  await waitFor(() => expect(window.location.search).toContain("bench=own"));
  expect(turns()).toEqual([{ do: "leave", to: "" }]);
});

it("leads a student to the bench that is shown to all", async () => {
  be("student", { id: "ada", bench: bench.id, shown: "shown" });
  at();
  act(() => useMe.setState({ at: bench.id }));
  const { user } = mount(<ClassLines />);
  await user.click(screen.getByRole("button", { name: "See it" }));
  expect(window.location.search).toContain("bench=shown");
});

it("tells a teacher that a class sees the bench, and ends that", async () => {
  server.on("GET", "/classes", { classes: [{ ...group, shown: bench.id }] });
  server.on("DELETE", "/classes/class-1/shown", group);
  at();
  const { user } = mount(<ClassLines />);
  await user.click(await screen.findByRole("button", { name: "End showing" }));
  expect(server.asked("DELETE", "/classes/class-1/shown")).toHaveLength(1);
  act(() => useView.setState({ page: "class" }));
  expect(screen.queryByText(/see this bench/)).not.toBeInTheDocument();
});

it("raises the hand of a student, takes it down, and says why not", async () => {
  be("student", { name: "Ada", class_name: "Tuesday" });
  const me = useMe.getState().me;
  server.on("PUT", "/me/hand", { ...me, hand: true });
  const { user } = mount(<Visitor />);
  await user.click(screen.getByRole("button", { name: "Raise hand" }));
  expect(await screen.findByRole("button", { name: "Hand up", pressed: true })).toBeVisible();
  server.on("PUT", "/me/hand", new Refusal(403, "The class is over."));
  await user.click(screen.getByRole("button", { name: "Hand up" }));
  expect(server.asked("PUT", "/me/hand").map(({ body }) => body)).toEqual([{ raised: true }, { raised: false }]);
  expect(await screen.findByText("The class is over.")).toBeVisible();
});
