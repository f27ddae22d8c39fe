import { fireEvent, screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import type { TrackDocument } from "./track-document";
import { TrackView } from "./track-view";

const found = vi.hoisted(() => ({ digests: {} as Record<string, string>, cases: [] as number[] }));
vi.mock("./track-run", () => ({
  TrackRun: class {
    done = 0;
    next = async () => {
      this.done += 1;
      found.cases.push(this.done);
    };
    digest = async (unit: string) => found.digests[unit];
  },
}));

const rows = [
  { unit: "mmae", title: "Kalman bank", log_score: 0.51234, digest: "aaaaaaaaaaaaaaaaaaaa" },
  { unit: "observer", title: "Observer", log_score: null, digest: "bbbbbbbbbbbbbbbbbbbb" },
];
const one = { group: 0, seed: "", samples: 4000, faults: [], events: [] };
const track = { note: "No more.", samples: 12_000, groups: [], cases: [one, one, one], rows };
const page: TrackDocument = { title: "Drift", summary: "Has it?", version: "1", index: "index.html", track };

async function show(): Promise<void> {
  const view = new TrackView({} as WebAssembly.Module, page);
  document.body.append(view.root);
  await view.estimate();
}

beforeEach(() => {
  document.body.replaceChildren();
  found.cases = [];
});

it("tells how long all cases need before they are computed", async () => {
  await show();
  expect(found.cases).toEqual([1]);
  expect(screen.getByRole("status").textContent).toMatch(/^3\scases, 12\D000\ssamples: about .* in this browser$/);
});

it("computes the cases one after another, and shows which digests are the published ones", async () => {
  found.digests = { mmae: rows[0].digest, observer: "cccccccccccccccccccc" };
  await show();
  fireEvent.click(screen.getByRole("button", { name: "Recompute here" }));
  await waitFor(() => expect(screen.getByRole("status")).toHaveTextContent(/^✗ 1 of 2 digests are the published ones/));
  expect(found.cases).toEqual([1, 1, 2, 3]);
  expect(screen.getByText(/^✓ aaaaaaaa/)).toHaveAttribute("data-same", "true");
  expect(screen.getByText(/^✗ cccccccc/)).toHaveAttribute("data-same", "false");
  expect(screen.getByRole("button")).toHaveTextContent("Recompute here");
});

it("stops after the case that is being computed", async () => {
  await show();
  const press = screen.getByRole("button");
  fireEvent.click(press);
  fireEvent.click(press);
  await waitFor(() => expect(screen.getByRole("status")).toHaveTextContent(/^Stopped after 1\scase$/));
  expect(document.querySelectorAll("[data-same]")).toHaveLength(0);
});
