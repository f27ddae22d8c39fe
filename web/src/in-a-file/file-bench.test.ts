import { expect, it } from "vitest";
import { recordedFolder } from "../testing/recorded";
import { FileBench } from "./file-bench";

const { code, document } = await recordedFolder();

it("goes back to a checkpoint with the values, faults and bits that it had there", async () => {
  const bench = await FileBench.load(code, document);
  const [path, { value, low, high, dependence }] = Object.entries(document.values)[0];
  const other = [...(dependence.grid ?? [low, high])].find((one) => one !== value) as number;
  bench.advance(50);
  const kept = bench.checkpoint();
  const change = () => {
    bench.apply({ set: { [path]: other } });
    bench.apply({ fault: "added_mass", severity: document.faults.added_mass.suggested });
    bench.advance(50);
    return bench.digest();
  };
  const digest = await change();
  expect(bench.values[path]).toBe(other);
  bench.restore(kept);
  expect([bench.tick, bench.values[path], [...bench.faults.keys()]]).toEqual([50, value, []]);
  expect(await change()).toBe(digest);
});

it("has the bits of its rows, one by one, where they run as segments", async () => {
  const run = async (segments: typeof document.segments) => {
    const bench = await FileBench.load(code, { ...document, segments });
    bench.advance(300);
    bench.apply({ fault: "added_mass", severity: document.faults.added_mass.suggested });
    bench.advance(300);
    bench.apply({ switch: "mrac" });
    bench.advance(300);
    return bench.digest();
  };
  expect(document.segments.length).toBeGreaterThan(0);
  expect(await run(document.segments)).toBe(await run([]));
});
