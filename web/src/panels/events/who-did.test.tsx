import { screen } from "@testing-library/react";
import { expect, it } from "vitest";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedBench } from "../../testing/recorded";
import { be, mount } from "../../testing/render";
import { EventsPanel } from "./events-panel";

const { bench } = await recordedBench("first-look");
const shared = { ...bench, company: { driver: "", people: [] } as never };
const entries = [
  { at: "2026-01-01T00:00:02Z", actor: "Ada <b>", text: "inject added_mass", tick: 1800 },
  { at: "2026-01-01T00:00:01Z", actor: "Ben", text: "came", tick: null },
];

it("lists who did what on a shared bench, the newest first", async () => {
  server.on("GET", "/classes", { classes: [] });
  server.on("GET", "/benches/:id/audit", { entries });
  connect(shared);
  const { user } = mount(<EventsPanel />);
  await user.click(screen.getByRole("radio", { name: "Who did what" }));
  const list = await screen.findByRole("list", { name: "Who did what, newest first" });
  await screen.findByText("Ada <b>");
  const rows = [...list.querySelectorAll("li")].map((row) => row.textContent?.replace(/\s/g, " "));
  expect(rows).toHaveLength(2);
  expect(rows[0]).toMatch(/Ada <b>: inject added_mass.*1.?800/);
  expect(rows[1]).toMatch(/Ben: came$/);
});

it("says that nothing was done yet, and that the server does not answer", async () => {
  server.on("GET", "/classes", { classes: [] });
  server.on("GET", "/benches/:id/audit", new Refusal(503, "The service is busy."));
  connect(shared);
  const { user } = mount(<EventsPanel />);
  await user.click(screen.getByRole("radio", { name: "Who did what" }));
  expect(await screen.findByText(/The service is busy|does not answer/)).toBeVisible();
});

it("is not for a student", () => {
  be("student");
  server.on("GET", "/classes", { classes: [] });
  connect(shared);
  mount(<EventsPanel />);
  expect(screen.queryByRole("radio", { name: "Who did what" })).not.toBeInTheDocument();
});
