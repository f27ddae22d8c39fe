import { screen } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { View3dHost } from "./view3d-host";
import { View3dPanel } from "./view3d-panel";

const { bench } = await recordedBench("first-look");
const gyroscope = await recordedBench("gyroscope");
const catalog = await recordedAnswer("catalog");
const { devices } = await recordedAnswer("devices");
const geometry = devices.find(({ id }) => id === "lcr-350")?.parameters.geometry;
const healthy = { ...bench, faults: [] };

beforeEach(() => {
  server.on("GET", "/catalog", catalog);
  server.on("POST", "/devices/evaluate", ({ body }: { body: { device: { id: string } } }) => ({
    geometry: body.device.id === "lcr-350" ? geometry : null,
    metrics: {},
    figures: [],
    sensitivities: {},
  }));
});

const plan = () => screen.findByRole("img", { name: /^The device from above/ });
const moved = (picture: HTMLElement) =>
  [...picture.querySelectorAll("[transform]")].map((part) => part.getAttribute("transform"));

it("draws the device from above, moving with the stream, where the browser has no WebGL", async () => {
  const board = connect({ ...healthy, parameters: { ...bench.parameters, device: { id: "lcr-350" } } });
  mount(
    <>
      <View3dPanel />
      <View3dHost />
    </>,
  );
  const picture = await plan();
  expect(document.querySelector("iframe")).toBeNull();
  expect(screen.getByText(/This browser has no WebGL/)).toBeVisible();
  await vi.waitFor(() => expect(picture.querySelectorAll("path").length).toBeGreaterThan(5));
  board.frame({ "plant.displacement": () => 2 }, { head: 100 });
  await drawOnce();
  const first = moved(picture);
  expect(first.length).toBeGreaterThan(4);
  board.frame({ "plant.displacement": () => -2 }, { head: 200 });
  await drawOnce();
  expect(moved(picture)).not.toEqual(first);
  expect(screen.getByText(/^, motion ×\d+$/)).toBeVisible();
  expect(picture.querySelector("[data-fault]")).toBeNull();
});

it("marks the part that a fault acts on, and names the fault", async () => {
  connect({ ...bench, parameters: { ...bench.parameters, device: { id: "lcr-350" } } });
  mount(<View3dPanel />);
  const picture = await screen.findByRole("img", { name: /with Added mass$/ });
  await vi.waitFor(() => expect(picture.querySelectorAll("[data-fault=true]")).toHaveLength(1));
  expect(screen.getByText("Added mass.")).toBeVisible();
});

it("draws another device for one without a drawing, and says so", async () => {
  connect(healthy);
  mount(<View3dPanel />);
  expect(await screen.findByText(/This device has no drawing; LCR-350 is shown/)).toBeVisible();
  await vi.waitFor(async () => expect((await plan()).querySelectorAll("path").length).toBeGreaterThan(5));
});

it("draws plate and frames of a gyroscope, along the axis of each", async () => {
  const board = connect(gyroscope.bench);
  mount(<View3dPanel />);
  const picture = await plan();
  board.frame({ "plant.x": () => 4, "plant.y": () => 1 }, { head: 100 });
  await drawOnce();
  const [drive, sense, plate] = moved(picture).map((text) => text?.match(/-?[\d.]+/g)?.map(Number));
  expect([drive?.[1], sense?.[0]]).toEqual([0, 0]);
  expect(plate).toEqual([drive?.[0], sense?.[1]]);
});

it("is drawn from above by a server without 3D", async () => {
  connect({ ...healthy, view3d: null });
  mount(<View3dPanel />);
  expect(await screen.findByText(/This server draws no 3D/)).toBeVisible();
});
