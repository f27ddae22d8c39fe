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
