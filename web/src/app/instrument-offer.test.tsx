import { screen, waitFor } from "@testing-library/react";
import { expect, it } from "vitest";
import type { ScenarioSummary } from "../api/types";
import { Refusal, server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { mount } from "../testing/render";
import { InstrumentOffer } from "./instrument-offer";

const { bench } = await recordedBench("first-look");
const all = (await recordedAnswer("scenarios")) as { scenarios: ScenarioSummary[] };
const scenarios = all.scenarios.filter(({ id }) => ["first-look", "ch5-seven-step"].includes(id));
const scope = { name: "scope", is_connected: true, rate_khz: 100 };

it("is absent where no instrument sends", async () => {
  server.on("GET", "/instruments", { listens: "", instruments: [{ ...scope, is_connected: false }] });
  mount(<InstrumentOffer scenarios={scenarios} devices={[]} />);
  await waitFor(() => expect(server.asked("GET", "/instruments")).not.toHaveLength(0));
  expect(screen.queryByRole("region", { name: "Instruments" })).toBeNull();
});

it("opens a bench on an instrument with the diagnosers of a scenario", async () => {
  server.on("GET", "/instruments", { listens: "127.0.0.1:1", instruments: [scope] });
  server.on("POST", "/instruments/:name/benches", bench);
  connect(bench);
  const { user } = mount(<InstrumentOffer scenarios={scenarios} devices={[]} />);
  await user.selectOptions(await screen.findByLabelText("Diagnosers of"), "ch5-seven-step");
  await user.click(screen.getByRole("button", { name: /^scope, live at 100\skHz$/ }));
  await waitFor(() =>
    expect(server.asked("POST", "/instruments/scope/benches")).toMatchObject([
      { body: { scenario: "ch5-seven-step" } },
    ]),
  );
  expect(screen.queryByLabelText("Device that they assume")).toBeNull();
});

it("opens it with a device that a record calibrated", async () => {
  server.on("GET", "/instruments", { listens: "127.0.0.1:1", instruments: [scope] });
  server.on("POST", "/instruments/:name/benches", bench);
  connect(bench);
  const device = { id: "d1", name: "die 7", record_key: "0f", values: {}, created: "2026-11-26T00:00:00Z" };
  const { user } = mount(<InstrumentOffer scenarios={scenarios} devices={[device]} />);
  await user.selectOptions(await screen.findByLabelText("Device that they assume"), "die 7, measured");
  await user.click(screen.getByRole("button", { name: /^scope, live at 100\skHz$/ }));
  await waitFor(() =>
    expect(server.asked("POST", "/instruments/scope/benches")).toMatchObject([{ body: { device: "d1" } }]),
  );
});

it("shows why a bench cannot be opened, and stays", async () => {
  server.on("GET", "/instruments", { listens: "127.0.0.1:1", instruments: [scope] });
  server.on("POST", "/instruments/:name/benches", new Refusal(409, "the server is full"));
  const { user } = mount(<InstrumentOffer scenarios={scenarios} devices={[]} />);
  await user.click(await screen.findByRole("button", { name: /^scope, live at 100\skHz$/ }));
  expect(screen.getByRole("button", { name: /^scope, live at 100\skHz$/ })).toBeVisible();
});
