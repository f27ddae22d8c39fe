import { screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { ownLinks } from "../bench/open-bench";
import { useView } from "../bench/view-store";
import { Refusal, server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { mount } from "../testing/render";
import { ShareSheet } from "./share-sheet";

const { bench } = await recordedBench("first-look");
const { bench: hidden } = await recordedAnswer("blind");
const LINK = { id: "ab3kmn7x", tick: 2000 };

beforeEach(() => {
  server.on("POST", "/links", LINK);
  server.on("PATCH", "/links/:id", LINK);
  server.on("GET", "/benches/:id/watchers", { watchers: [] });
});

async function open(of = bench) {
  const board = connect(of);
  useView.setState({ dialog: "share" });
  const shown = mount(<ShareSheet />);
  return { board, ...shown, sheet: within(await screen.findByRole("dialog", { name: "Share this experiment" })) };
}

it("makes one link of the moment at which it is opened, and says which", async () => {
  const { board, sheet } = await open();
  expect(await sheet.findByText(/at tick 2\s?000 with the same bits/)).toBeVisible();
  expect(sheet.getByRole("textbox", { name: "Link" })).toHaveValue("http://localhost:3000/?link=ab3kmn7x");
  expect(sheet.getByRole("img", { name: /^QR code of .*link=ab3kmn7x/ })).toBeVisible();
  expect(sheet.getByText(/^Other computers cannot reach this address/)).toBeVisible();
  board.status({ tick: 2001 });
  expect(server.asked("POST", "/links").map(({ body }) => body)).toEqual([
    { bench: bench.id, title: "", note: "", layout: null },
  ]);
  expect(ownLinks()).toEqual([LINK.id]);
});

it("keeps a note once, when it is left or the link is copied", async () => {
  const { user, sheet } = await open();
  const note = await sheet.findByLabelText(/^Note/);
  await user.type(note, "Watch the mass.");
  expect(server.asked("PATCH", "/links/ab3kmn7x")).toEqual([]);
  await user.click(sheet.getByRole("button", { name: "Copy" }));
  expect(await sheet.findByRole("button", { name: "Copied" })).toBeVisible();
  expect(await navigator.clipboard.readText()).toBe("http://localhost:3000/?link=ab3kmn7x");
  expect(server.asked("PATCH", "/links/ab3kmn7x").map(({ body }) => body)).toEqual([{ note: "Watch the mass." }]);
});

it("says why there is no link, and what to do", async () => {
  server.on("POST", "/links", new Refusal(409, "The log is too long.", { hint: "Fork the bench." }));
  const { sheet } = await open();
  expect(await sheet.findByText("The log is too long.")).toBeVisible();
  expect(sheet.getByText("Fork the bench.")).toBeVisible();
  expect(sheet.queryByRole("textbox", { name: "Link" })).not.toBeInTheDocument();
});

it("makes no link while a fault is hidden", async () => {
  const { sheet } = await open(hidden);
  expect(sheet.getByText("Answer first")).toBeVisible();
  expect(sheet.queryByRole("textbox")).not.toBeInTheDocument();
  expect(server.requests).toEqual([]);
});

it("lets people watch by the link for some hours, says so, and ends it", async () => {
  const until = "2026-01-01T00:00:00Z";
  server.on("POST", "/benches/:id/watchers", { id: "w1", until, path: "/?link=ab3kmn7x" });
  server.on("DELETE", "/benches/:id/watchers/w1");
  const { user, sheet } = await open();
  expect(await sheet.findByText(/must enter the access token/)).toBeVisible();
  await user.clear(sheet.getByLabelText("Lasts, hours"));
  await user.type(sheet.getByLabelText("Lasts, hours"), "2");
  server.on("GET", "/benches/:id/watchers", { watchers: [{ id: "w1", until }] });
  await user.click(sheet.getByRole("button", { name: "Let people watch" }));
  expect(await sheet.findByText(/All others watch this bench live/)).toBeVisible();
  expect(sheet.getByRole("textbox", { name: "Link" })).toHaveValue("http://localhost:3000/?link=ab3kmn7x");
  expect(server.asked("POST", `/benches/${bench.id}/watchers`)[0].body).toEqual({ hours: 2, link: LINK.id });
  const list = within(await sheet.findByRole("list", { name: "Links by which people watch this bench" }));
  server.on("GET", "/benches/:id/watchers", { watchers: [] });
  await user.click(list.getByRole("button", { name: "End" }));
  await waitFor(() => expect(sheet.queryByText(/^Lasts until/)).not.toBeInTheDocument());
  expect(server.asked("DELETE", `/benches/${bench.id}/watchers/w1`)).toHaveLength(1);
  expect(await sheet.findByText(/must enter the access token/)).toBeVisible();
});

it.each(["0", "337"])("lets nobody watch for %s hours", async (hours) => {
  const { user, sheet } = await open();
  await user.clear(await sheet.findByLabelText("Lasts, hours"));
  await user.type(sheet.getByLabelText("Lasts, hours"), hours);
  expect(sheet.getByRole("button", { name: "Let people watch" })).toBeDisabled();
  expect(sheet.getByText("More than 0, at most 336")).toBeVisible();
});

it("says why nobody may watch", async () => {
  server.on("POST", "/benches/:id/watchers", new Refusal(409, "There are too many links."));
  const { user, sheet } = await open();
  await user.click(await sheet.findByRole("button", { name: "Let people watch" }));
  expect(await screen.findByText("There are too many links.")).toBeVisible();
  await vi.waitFor(() => expect(sheet.getByRole("button", { name: "Let people watch" })).toBeEnabled());
});
