import { act } from "@testing-library/react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { useMe } from "../api/me";
import { benchInAddress } from "../bench/open-bench";
import { server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { recordedBench } from "../testing/recorded";
import { be, mount } from "../testing/render";
import { VoteCard } from "./vote-card";

const { bench } = await recordedBench("first-look");

beforeEach(() => void vi.useFakeTimers({ toFake: ["setInterval", "clearInterval"] }));
afterEach(() => vi.useRealTimers());

it("goes to the bench that was lent to the student since the last question", async () => {
  be("student", { bench: bench.id });
  connect(bench);
  mount(<VoteCard />);
  server.on("GET", "/me", { ...useMe.getState().me, lent: "b0b" });
  await act(() => vi.advanceTimersByTimeAsync(4000));
  await vi.waitFor(() => expect(benchInAddress()).toBe("b0b"));
});
