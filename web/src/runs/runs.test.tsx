import { screen } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { showAddress, useView } from "../bench/view-store";
import { server } from "../testing/fake-server";
import { recordedAnswer } from "../testing/recorded";
import { be, mount } from "../testing/render";
import { Runs } from "./runs";

const benchmark = await recordedAnswer("benchmark");
const catalog = await recordedAnswer("catalog");

beforeEach(() => {
  server.on("GET", "/benchmarks/mems-diag-1", benchmark);
  server.on("GET", "/catalog", catalog);
  server.on("GET", "/scenarios", { scenarios: [] });
  server.on("GET", "/scenarios/:id", { document: {} });
  server.on("GET", "/runs", { runs: [] });
  server.on("GET", "/sweeps", { sweeps: [] });
});

/** The page of an address. */
function open(query: string) {
  window.history.replaceState(null, "", query);
  showAddress();
  return mount(<Runs />);
}
const tabs = () => screen.getAllByRole("tab").map((tab) => tab.textContent);

it("has the runs in front and the scores a tab away; the address names the tab", async () => {
  const { user } = open("/runs");
  expect(await screen.findByText("Nothing has been run yet")).toBeVisible();
  await user.click(screen.getByRole("tab", { name: "Scores" }));
  expect(await screen.findByRole("heading", { name: "Benchmark" })).toBeVisible();
  expect(window.location.pathname).toBe("/scores");
  expect(screen.queryByText("Nothing has been run yet")).not.toBeInTheDocument();
});

it.each(["/?page=benchmark", "/scores"])("opens %s at the scores", async (query) => {
  open(query);
  expect(useView.getState().page).toBe("benchmark");
  expect(await screen.findByRole("heading", { name: "Benchmark" })).toBeVisible();
  expect(screen.getByRole("tab", { selected: true })).toHaveTextContent("Scores");
});

it.each(["student", "watcher"] as const)("has the scores alone for a %s, and asks for no run", async (role) => {
  be(role);
  open("/?page=runs");
  expect(tabs()).toEqual(["Scores"]);
  expect(await screen.findByRole("heading", { name: "Benchmark" })).toBeVisible();
  expect(server.asked("GET", "/runs")).toEqual([]);
});
