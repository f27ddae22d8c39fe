import { waitFor } from "@testing-library/react";
import { expect, it } from "vitest";
import { useMe } from "../api/me";
import { openBench } from "../bench/open-bench";
import { server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { recordedBench } from "../testing/recorded";
import { be } from "../testing/render";
import { comeBack, openFirstBench } from "./first-bench";

const { bench } = await recordedBench("first-look");
const TEACHER = { role: "teacher", name: "", class: null, bench: null };
const shown = () => useMe.getState().at;

/** The server answers about the bench in the address only when the test says so. */
function slowServer(): () => void {
  be("teacher");
  connect(bench);
  let resolve = () => {};
  const promise = new Promise<void>((done) => {
    resolve = done;
  });
  window.history.replaceState(null, "", "/?bench=stage");
  server.on("GET", "/me", TEACHER);
  server.on("GET", "/benches/stage", async () => {
    await promise;
    return { ...bench, id: "stage" };
  });
  return () => resolve();
}

it.each([
  ["a page loads", openFirstBench],
  ["a page comes back", comeBack],
])("%s: the bench in the address does not replace a bench opened while the server was asked", async (_, open) => {
  const answer = slowServer();
  const opened = open();
  await waitFor(() => expect(server.asked("GET", "/benches/stage")).toHaveLength(1));
  openBench("before", true);
  answer();
  await opened;
  expect(shown()).toBe("before");
});

it("opens the bench in the address when no other was opened meanwhile", async () => {
  const answer = slowServer();
  const opened = openFirstBench();
  answer();
  await opened;
  expect(shown()).toBe("stage");
});
