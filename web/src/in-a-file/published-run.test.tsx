import { fireEvent, screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import type { FileBench } from "./file-bench";
import { PublishedRun } from "./published-run";

const DIGEST = "0123456789abcdef0123";
const published = { source: "3.1", claim: "It tracks.", verdict: "reproduced", ticks: 1300, digest: DIGEST, marks: [] };
const row = { metric: "control.rms_error_um", published: "small", expected: "at most 2", measured: "1 um", ok: true };

/** A bench that counts ticks, up to a last tick. */
class CountingBench {
  tick = 77;
  readonly found: string;
  readonly last: number;
  constructor(found: string, last = Number.POSITIVE_INFINITY) {
    this.found = found;
    this.last = last;
  }
  reset = () => {
    this.tick = 0;
  };
  advance = (n: number) => {
    const ran = Math.min(n, this.last - this.tick);
    this.tick += ran;
    return ran;
  };
  digest = () => Promise.resolve(this.found);
}

function show(bench: CountingBench): PublishedRun {
  const run = new PublishedRun(bench as unknown as FileBench, { ...published, expectations: [row] });
  document.body.append(run.root);
  return run;
}

beforeEach(() => document.body.replaceChildren());

it("computes the whole run from tick 0 and says in words that the digest is the same", async () => {
  const bench = new CountingBench(DIGEST);
  const run = show(bench);
  fireEvent.click(screen.getByRole("button", { name: "Recompute here" }));
  expect(run.isComputing).toBe(true);
  await waitFor(() => expect(screen.getByText(/The same digest/).dataset.same).toBe("true"));
  expect(bench.tick).toBe(published.ticks);
  expect(run.isComputing).toBe(false);
});

it("says that the digest is another, also where the run stops early", async () => {
  show(new CountingBench("f".repeat(20), 900));
  fireEvent.click(screen.getByRole("button", { name: "Recompute here" }));
  await waitFor(() => expect(screen.getByText(/Another digest/).dataset.same).toBe("false"));
});

it("stops when it is told to, without a verdict", async () => {
  const bench = new CountingBench(DIGEST);
  bench.advance = () => 1;
  const run = show(bench);
  fireEvent.click(screen.getByRole("button", { name: "Recompute here" }));
  fireEvent.click(screen.getByRole("button", { name: "Stop" }));
  await waitFor(() => expect(screen.getByRole("button", { name: "Recompute here" })).toBeTruthy());
  expect(run.isComputing).toBe(false);
  expect(screen.queryByText(/digest:/)).toBeNull();
});

it("shows claim, verdict and figures, each figure with a word beside its colour", () => {
  show(new CountingBench(DIGEST));
  expect(screen.getByText("It tracks.")).toBeTruthy();
  expect(screen.getByText("reproduced")).toBeTruthy();
  expect(screen.getByText("✓ 1 um").dataset.same).toBe("true");
});
